#include "design/shared_work.h"

#include <fmt/format.h>

#include "base/byte_record.h"
#include "design/brief.h"
#include "sim/photon_fields.h"

namespace catoptric::design {
namespace {

/// What ranks share of a verdict by photons.
std::string tasks(const Scene& scene) {
  const sim::EstimateOptions bandwidth = scene.model.estimate;
  const std::uint64_t batches =
      sim::photon_batches(scene.model.photons.photons, std::span(&bandwidth, 1), 1 + scene.fields.size());
  return batches == 1
             ? fmt::format("{} replicates", scene.model.replicates)
             : fmt::format("{} batches of photons of each of {} replicates", batches, scene.model.replicates);
}

}  // namespace

Ranks& ranks_of(const Scene& scene) {
  return scene.model.photons.ranks ? *scene.model.photons.ranks : lone_process();
}
Ranks& ranks_of(const RunControl& control) { return control.ranks ? *control.ranks : lone_process(); }

Scene shared(Scene scene, const RunControl& control) {
  scene.model.photons.ranks = control.ranks;
  return scene;
}

Scene controlled(Scene scene, const RunControl& control) {
  return stoppable(shared(std::move(scene), control), control.stop);
}

bool stopped_for_all(const RunControl& control) {
  return ranks_of(control).from_first([&] { return ByteWriter().put(control.stopped()).take(); }).front() !=
         0;
}

double of_first(Ranks& ranks, double value) {
  const Bytes bytes = ranks.from_first([&] { return ByteWriter().put(value).take(); });
  return ByteReader(bytes).get<double>();
}

Bytes as_bytes(const Evaluation& evaluation) {
  return ByteWriter()
      .put(evaluation.rung)
      .put(evaluation.direct)
      .put(evaluation.reflected)
      .put(evaluation.sharp)
      .put(evaluation.kernel_radius_mm)
      .put(evaluation.energy)
      .put(evaluation.counts)
      .take();
}

Evaluation evaluation_of(const Bytes& bytes) {
  Evaluation evaluation;
  ByteReader(bytes)
      .get(evaluation.rung)
      .get(evaluation.direct)
      .get(evaluation.reflected)
      .get(evaluation.sharp)
      .get(evaluation.kernel_radius_mm)
      .get(evaluation.energy)
      .get(evaluation.counts);
  return evaluation;
}

Bytes as_bytes(const optim::Outcome& outcome) {
  ByteWriter writer;
  writer.put(outcome.ending)
      .put(outcome.sentence)
      .put(outcome.best)
      .put(outcome.value)
      .put(outcome.start_value)
      .put(outcome.successes)
      .put(outcome.iterations)
      .put(outcome.evaluations)
      .put(outcome.cache_hits)
      .put(outcome.restarts)
      .put(outcome.history.size());
  for (const optim::Iterate& each : outcome.history)
    writer.put(each.k)
        .put(each.iteration)
        .put(each.evaluations)
        .put(each.step)
        .put(each.move)
        .put(each.x)
        .put(each.value);
  return writer.take();
}

optim::Outcome outcome_of(const Bytes& bytes) {
  optim::Outcome outcome{};
  ByteReader reader(bytes);
  reader.get(outcome.ending)
      .get(outcome.sentence)
      .get(outcome.best)
      .get(outcome.value)
      .get(outcome.start_value)
      .get(outcome.successes)
      .get(outcome.iterations)
      .get(outcome.evaluations)
      .get(outcome.cache_hits)
      .get(outcome.restarts);
  outcome.history.resize(reader.get<std::size_t>());
  for (optim::Iterate& each : outcome.history)
    reader.get(each.k)
        .get(each.iteration)
        .get(each.evaluations)
        .get(each.step)
        .get(each.move)
        .get(each.x)
        .get(each.value);
  return outcome;
}

Bytes as_bytes(const sim::AccurateField& field) {
  return ByteWriter()
      .put(field.rung)
      .put(field.proven)
      .put(field.sentence)
      .put(field.breaks.has_value())
      .put(field.breaks.value_or(""))
      .put(field.direct)
      .put(field.reflected)
      .put(field.noise)
      .put(field.noise_rel)
      .put(field.bias_rel)
      .put(field.error95_rel)
      .put(field.kernel_radius_mm)
      .put(field.order)
      .put(field.sets)
      .put(field.photons)
      .put(field.spent_photons)
      .put(field.rays)
      .put(field.by_set)
      .put(field.stages)
      .put(field.energy)
      .put(field.counts)
      .take();
}

sim::AccurateField accurate_field_of(const Bytes& bytes) {
  sim::AccurateField field;
  ByteReader reader(bytes);
  reader.get(field.rung).get(field.proven).get(field.sentence);
  const bool has_breaks = reader.get<bool>();
  std::string breaks;
  reader.get(breaks);
  if (has_breaks) field.breaks = std::move(breaks);
  reader.get(field.direct)
      .get(field.reflected)
      .get(field.noise)
      .get(field.noise_rel)
      .get(field.bias_rel)
      .get(field.error95_rel)
      .get(field.kernel_radius_mm)
      .get(field.order)
      .get(field.sets)
      .get(field.photons)
      .get(field.spent_photons)
      .get(field.rays)
      .get(field.by_set)
      .get(field.stages)
      .get(field.energy)
      .get(field.counts);
  return field;
}

Bytes as_bytes(const SearchPath& path) {
  return ByteWriter()
      .put(path.name)
      .put(path.label)
      .put(path.points)
      .put(path.values)
      .put(path.ending)
      .take();
}

SearchPath search_path_of(const Bytes& bytes) {
  SearchPath path;
  ByteReader(bytes).get(path.name).get(path.label).get(path.points).get(path.values).get(path.ending);
  return path;
}

bool shares_evaluations(const Scene& scene, sim::Rung rung, const Ranks& ranks) {
  return ranks.size() > 1 && rung != sim::Rung::tubes && scene.search.method != "none" &&
         scene.search.method != "levenberg-marquardt";
}

std::string sharing_sentence(const Scene& scene, const std::optional<sim::Rung>& searched,
                             const Ranks& ranks) {
  if (ranks.size() == 1) return "";
  std::string sentence =
      scene.accuracy_rel
          ? fmt::format(
                "{} ranks: each keeps a part of the photons that the accuracy takes, if "
                "it takes any, and looks at it",
                ranks.size())
          : fmt::format("{} ranks: the {} of a verdict are shared", ranks.size(), tasks(scene));
  if (searched && shares_evaluations(scene, *searched, ranks))
    sentence +=
        fmt::format("; a search computes up to {} points that it may ask for side by side", ranks.size());
  else if (searched)
    sentence +=
        "; the search is rank 0's alone, since its evaluations are too quick to be sent about or come one "
        "after another";
  return sentence;
}

}  // namespace catoptric::design
