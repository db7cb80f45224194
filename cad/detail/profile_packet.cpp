#include "cad/detail/profile_packet.h"

#include "cad/detail/byte_packet.h"

namespace catoptric::cad::detail {

std::string pack_profile(const ImportedProfile& imported) {
  BytePacket packet;
  packet.put(static_cast<std::size_t>(imported.profile.degree()));
  packet.put(imported.profile.knots().size());
  for (const double knot : imported.profile.knots()) packet.put(knot);
  packet.put(imported.profile.points().size());
  for (const ControlPoint& point : imported.profile.points())
    for (const double value : {point.r_mm, point.z_mm, point.weight}) packet.put(value);
  for (const auto* texts : {&imported.notes, &imported.candidates}) {
    packet.put(texts->size());
    for (const std::string& text : *texts) packet.put(text);
  }
  return packet.bytes();
}

ImportedProfile unpack_profile(const std::string& bytes, const std::filesystem::path& file) {
  ByteReader reader(bytes);
  const int degree = static_cast<int>(reader.count());
  std::vector<double> knots(reader.count_of(sizeof(double)));
  for (double& knot : knots) knot = reader.number();
  std::vector<ControlPoint> points(reader.count_of(3 * sizeof(double)));
  for (ControlPoint& point : points) {
    point.r_mm = reader.number();
    point.z_mm = reader.number();
    point.weight = reader.number();
  }
  std::vector<std::string> notes(reader.count_of(sizeof(std::size_t)));
  for (std::string& text : notes) text = reader.text();
  std::vector<std::string> candidates(reader.count_of(sizeof(std::size_t)));
  for (std::string& text : candidates) text = reader.text();
  if (!reader.is_whole() || Profile::find_defect(degree, knots, points))
    throw CadError({"the file cannot be read", file.string(),
                    "it is broken: what OpenCASCADE made of it is no curve", "export it again"});
  return {Profile(degree, std::move(knots), std::move(points)), std::move(notes), std::move(candidates)};
}

}  // namespace catoptric::cad::detail
