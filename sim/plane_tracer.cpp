#include "sim/plane_tracer.h"

#include <algorithm>
#include <cmath>

#include "base/float_traps.h"
#include "base/profile.h"
#include "base/random_stream.h"
#include "base/tolerance.h"
#include "base/vector_clones.h"

namespace catoptric::sim {
namespace {

constexpr std::size_t block_photons = 128;
using Row = double[block_photons];

/// The way to the near field's plane, in numbers.
struct PlaneNumbers {
  explicit PlaneNumbers(const NearField& field) {
    for (int i = 0; i < 3; ++i) {
      center[i] = field.center_mm()[i];
      normal[i] = field.normal()[i];
      first[i] = field.first_axis()[i];
      second[i] = field.second_axis()[i];
    }
  }
  double center[3], normal[3], first[3], second[3];
};

/// Where a way in the meridian plane meets the near field's plane.
struct Meeting {
  double distance_mm;
  double x_mm, y_mm;  ///< plane coordinates
  double climb;       ///< of the way, along the normal
  bool ahead;
};

[[gnu::always_inline]] inline Meeting meet(const PlaneNumbers& plane, double r_mm, double z_mm, double dr,
                                           double dz, double azimuth_cosine, double azimuth_sine) {
  const double x = r_mm * azimuth_cosine - plane.center[0], y = r_mm * azimuth_sine - plane.center[1],
               z = z_mm - plane.center[2];
  const double dx = dr * azimuth_cosine, dy = dr * azimuth_sine;
  const double height = x * plane.normal[0] + y * plane.normal[1] + z * plane.normal[2];
  const double climb = dx * plane.normal[0] + dy * plane.normal[1] + dz * plane.normal[2];
  const double distance = -height / climb;
  const double at_x = x + distance * dx, at_y = y + distance * dy, at_z = z + distance * dz;
  return {distance, at_x * plane.first[0] + at_y * plane.first[1] + at_z * plane.first[2],
          at_x * plane.second[0] + at_y * plane.second[1] + at_z * plane.second[2], climb,
          height * climb < 0};
}

/// Photons that go together. Every row is one number of each of them.
struct Rows {
  Row x, z, dx, dz;                                  ///< ways from the source
  Row distance, hit_x, hit_z, tangent_x, tangent_z;  ///< their first hits
  Row after_dx, after_dz;                            ///< reflected ways
  Row field_x, field_y;                              ///< where those meet the near field's plane
  Row meets, climbs, leaves;  ///< 1 or 0: do they; along its normal; through the mouth for good
};

CATOPTRIC_VECTOR_CLONES
void start(std::size_t count, double source_z, const double* __restrict cosine, Rows& rows) {
  for (std::size_t i = 0; i < count; ++i) {
    rows.x[i] = 0;
    rows.z[i] = source_z;
    rows.dx[i] = std::sqrt((1 - cosine[i]) * (1 + cosine[i]));
    rows.dz[i] = cosine[i];
  }
}

/// Reflects the photons at their hits and follows them to the plane.
CATOPTRIC_VECTOR_CLONES
void reflect_all(std::size_t count, const PlaneNumbers& numbers, const double* __restrict azimuth_cosine,
                 const double* __restrict azimuth_sine, Rows& rows) {
  const UntrappedFloats untrapped;  // what missed the mirror has no tangent; nothing of it is taken
  const PlaneNumbers plane = numbers;
  for (std::size_t i = 0; i < count; ++i) {
    // What is along the tangent stays, the rest turns round; unit length again, as in space.
    const double tx = rows.tangent_x[i], tz = rows.tangent_z[i];
    const double along = 2 * (rows.dx[i] * tx + rows.dz[i] * tz);
    const double x = along * tx - rows.dx[i], z = along * tz - rows.dz[i];
    const double length = std::sqrt(x * x + z * z), dx = x / length, dz = z / length;
    const Meeting at = meet(plane, rows.hit_x[i], rows.hit_z[i], dx, dz, azimuth_cosine[i], azimuth_sine[i]);
    rows.after_dx[i] = dx;
    rows.after_dz[i] = dz;
    rows.field_x[i] = at.x_mm;
    rows.field_y[i] = at.y_mm;
    rows.meets[i] = at.ahead ? 1 : 0;
    rows.climbs[i] = at.climb < 0 ? 0 : 1;
  }
}

CATOPTRIC_VECTOR_CLONES
void mark_leaving(std::size_t count, const Opening& opening, Rows& rows) {
  const UntrappedFloats untrapped;  // as above
  const Opening mouth = opening;
  for (std::size_t i = 0; i < count; ++i)
    rows.leaves[i] = mouth.lets_out(rows.hit_x[i], rows.hit_z[i], rows.after_dx[i], rows.after_dz[i]) ? 1 : 0;
}

}  // namespace

struct PlaneTracer::Block : Rows {
  PlaneEmission from;  ///< as many numbers as photons
  std::size_t count() const { return from.cosine.size(); }
};

struct PlaneTracer::Photon {
  // Not an aggregate, which would set every byte of the stream to zero for photons that ask it for nothing.
  Photon(std::uint64_t its_number, double cosine, double sine, const PlanarRay& way)
      : number(its_number), azimuth_cosine(cosine), azimuth_sine(sine), ray(way) {}
  std::uint64_t number;
  double azimuth_cosine, azimuth_sine;
  PlanarRay ray;
  std::optional<RandomStream> chance;
  bool touched = false;   ///< has met the mirror
  bool received = false;  ///< has crossed the invisible near field's own area from the front
  bool on_field = false;  ///< starts from the near field, whose plane it cannot meet again before turning
  int interactions = 0;
};

struct PlaneTracer::Arrival {
  double distance_mm;
  Vector2 plane_mm;
  bool from_front;
};

bool PlaneScene::possible(const Scene& scene) {
  const Vector3 source = scene.source.position_mm();
  const auto& material = scene.near_field.material();
  return scene.is_bare() && dynamic_cast<const PointSource*>(&scene.source) != nullptr &&
         scene.source.tilt_rad() == 0 && source.x() == 0 && source.y() == 0 &&
         !(material && reflects(*material)) && is_specular(scene.mirror) &&
         scene.reflector.engine() == "meridian";
}

PlaneScene::PlaneScene(const Scene& whole, const RecordedArea& recorded)
    : scene(whole),
      area(recorded),
      patch(RecordedArea::about(whole.near_field, 0)),
      mirror(scene.reflector.profile()),
      opening(Opening::of(scene.reflector.profile())),
      lift_mm(Tolerance::for_scale(scene.reflector.profile().diagonal_mm()).lift_mm) {}

void PlaneTracer::trace(std::uint64_t first, const PlaneEmission& emission) {
  const std::size_t count = emission.cosine.size();
  crossings_.reserve(crossings_.size() + count);
  Block block;
  for (std::size_t i = 0; i < count; i += block_photons) {
    const std::size_t length = std::min(block_photons, count - i);
    block.from = {emission.cosine.subspan(i, length), emission.azimuth_cosine.subspan(i, length),
                  emission.azimuth_sine.subspan(i, length)};
    trace_block(first + i, block);
  }
  counts_.stored = crossings_.size();
}

void PlaneTracer::trace_block(std::uint64_t first, Block& block) {
  const std::size_t count = block.count();
  start(count, scene_.scene.source.position_mm().z(), block.from.cosine.data(), block);
  scene_.mirror.first_hits({{block.x, count}, {block.z, count}, {block.dx, count}, {block.dz, count}},
                           scene_.lift_mm,
                           {{block.distance, count},
                            {block.hit_x, count},
                            {block.hit_z, count},
                            {block.tangent_x, count},
                            {block.tangent_z, count}});
  reflect_all(count, PlaneNumbers(scene_.scene.near_field), block.from.azimuth_cosine.data(),
              block.from.azimuth_sine.data(), block);
  if (scene_.opening)
    mark_leaving(count, *scene_.opening, block);
  else
    std::fill_n(block.leaves, count, 0.0);
  // Most photons leave at once where the near field is not in their way and chance has no say.
  const bool plain = !scene_.scene.near_field.material() && reflects_for_certain(scene_.scene.mirror);
  std::size_t left = 0, received = 0;
  for (std::size_t i = 0; i < count; ++i) {
    if (plain & (block.leaves[i] != 0) & (block.distance[i] < HUGE_VAL)) {
      ++left;
      received += record_leaving(first + i, block, i);
    } else {
      ++counts_.ended[static_cast<std::size_t>(settle(first + i, block, i))];
    }
  }
  counts_.met_mirror += left;
  counts_.interactions += left;
  counts_.ended[static_cast<std::size_t>(Fate::received)] += received;
  counts_.ended[static_cast<std::size_t>(Fate::escaped)] += left - received;
}

inline bool PlaneTracer::record(std::uint64_t number, const Arrival& arrival) {
  if (!scene_.area.contains(arrival.plane_mm)) return false;
  crossings_.push_back(
      {arrival.plane_mm.x(), arrival.plane_mm.y(), 2 * number + (arrival.from_front ? 1 : 0)});
  return arrival.from_front && scene_.patch.contains(arrival.plane_mm);
}

inline bool PlaneTracer::record_leaving(std::uint64_t number, const Block& block, std::size_t i) {
  return block.meets[i] != 0 &&
         record(number, {0, {block.field_x[i], block.field_y[i]}, block.climbs[i] == 0});
}

Fate PlaneTracer::settle(std::uint64_t number, const Block& block, std::size_t i) {
  Photon photon(number, block.from.azimuth_cosine[i], block.from.azimuth_sine[i],
                {block.x[i], block.z[i], block.dx[i], block.dz[i]});
  if (scene_.scene.near_field.material()) return follow(photon);  // it may stand in any way
  if (!(block.distance[i] < HUGE_VAL)) return Fate::missed;
  ++counts_.met_mirror;
  ++counts_.interactions;
  const double cosine =
      std::min(1.0, std::abs(block.dx[i] * block.tangent_z[i] - block.dz[i] * block.tangent_x[i]));
  const Interaction interaction = decide(scene_.scene.mirror, Roulette::survivors, cosine, photon);
  if (interaction == Interaction::absorbed) return Fate::absorbed;
  const bool reflected = interaction == Interaction::reflected;
  if (reflected && block.leaves[i] != 0)
    return record_leaving(number, block, i) ? Fate::received : Fate::escaped;
  photon.touched = true;
  photon.interactions = 1;
  photon.ray.x_mm = block.hit_x[i];
  photon.ray.z_mm = block.hit_z[i];
  if (reflected) photon.ray.dx = block.after_dx[i], photon.ray.dz = block.after_dz[i];
  return follow(photon);
}

Fate PlaneTracer::follow(Photon& photon) {
  const NearField& field = scene_.scene.near_field;
  for (;;) {
    const auto hit = next_hit(photon);
    const auto arrival = meet_plane(photon, hit ? hit->distance_mm : HUGE_VAL);
    const bool stops = arrival && field.material() && scene_.patch.contains(arrival->plane_mm);
    if (arrival && photon.touched && record(photon.number, *arrival)) photon.received = true;
    if (!stops && !hit)
      return !photon.touched ? Fate::missed : photon.received ? Fate::received : Fate::escaped;
    if (photon.interactions == most_interactions_) return Fate::cut_off;
    ++photon.interactions;
    ++counts_.interactions;
    if (stops) {
      photon.on_field = true;
      photon.ray.x_mm += arrival->distance_mm * photon.ray.dx;
      photon.ray.z_mm += arrival->distance_mm * photon.ray.dz;
      if (decide(*field.material(), Roulette::all, 1, photon) == Interaction::absorbed)
        return photon.touched ? Fate::received : Fate::missed;
    } else if (!leave_mirror(photon, *hit)) {
      return Fate::absorbed;
    }
  }
}

std::optional<PlanarHit> PlaneTracer::next_hit(const Photon& photon) const {
  const PlanarRay& ray = photon.ray;
  if (photon.touched && !photon.on_field && scene_.opening &&
      scene_.opening->lets_out(ray.x_mm, ray.z_mm, ray.dx, ray.dz))
    return std::nullopt;
  return scene_.mirror.first_hit(ray, scene_.lift_mm);
}

std::optional<PlaneTracer::Arrival> PlaneTracer::meet_plane(const Photon& photon, double reach_mm) const {
  if (photon.on_field) return std::nullopt;
  const PlanarRay& ray = photon.ray;
  const Meeting at = meet(PlaneNumbers(scene_.scene.near_field), ray.x_mm, ray.z_mm, ray.dx, ray.dz,
                          photon.azimuth_cosine, photon.azimuth_sine);
  if (!at.ahead || !(at.distance_mm <= reach_mm)) return std::nullopt;
  return Arrival{at.distance_mm, {at.x_mm, at.y_mm}, at.climb < 0};
}

bool PlaneTracer::leave_mirror(Photon& photon, const PlanarHit& hit) {
  const bool first = !photon.touched;
  if (first) ++counts_.met_mirror;
  photon.touched = true;
  photon.on_field = false;
  photon.ray.x_mm = hit.x_mm;
  photon.ray.z_mm = hit.z_mm;
  const double cosine = std::min(1.0, std::abs(photon.ray.dx * hit.tz - photon.ray.dz * hit.tx));
  const Interaction interaction =
      decide(scene_.scene.mirror, first ? Roulette::survivors : Roulette::all, cosine, photon);
  if (interaction == Interaction::reflected) {
    const double along = 2 * (photon.ray.dx * hit.tx + photon.ray.dz * hit.tz);
    const double dx = along * hit.tx - photon.ray.dx, dz = along * hit.tz - photon.ray.dz;
    const double length = std::sqrt(dx * dx + dz * dz);
    photon.ray.dx = dx / length;
    photon.ray.dz = dz / length;
  }
  return interaction != Interaction::absorbed;
}

double PlaneTracer::chance_of(Photon& photon) const {
  if (!photon.chance) photon.chance.emplace(key_, Purpose::interaction, photon.number);
  return photon.chance->uniform();
}

/// Of surfaces that nothing but mirror or let through.
Interaction PlaneTracer::decide(const Material& material, Roulette roulette, double cosine,
                                Photon& photon) const {
  const Lobe lobe = choose_lobe(material, roulette, cosine, [&] { return chance_of(photon); }).lobe;
  return lobe == Lobe::mirror    ? Interaction::reflected
         : lobe == Lobe::through ? Interaction::transmitted
                                 : Interaction::absorbed;
}

}  // namespace catoptric::sim
