#include "cad/meridian_reflector.h"

#include <algorithm>
#include <utility>

#include "cad/engines.h"
#include "cad/meridian_fast.h"

namespace catoptric::cad {
namespace {

template <int Degree>
class MeridianReflector final : public Reflector {
 public:
  explicit MeridianReflector(const Profile& profile) : profile_(profile), table_(profile_), fast_(table_) {}
  std::unique_ptr<Probe> probe() const override {
    return std::make_unique<meridian::FastProbe<Degree>>(table_, fast_);
  }
  const Profile& profile() const override { return profile_; }
  std::string_view engine() const override { return "meridian"; }

 private:
  Profile profile_;
  meridian::SpanTable table_;
  meridian::FastTable fast_;
};

template <int... Offsets>
std::unique_ptr<Reflector> make(const Profile& profile, std::integer_sequence<int, Offsets...>) {
  std::unique_ptr<Reflector> made;
  ((profile.degree() == Offsets + 1 &&
    (made = std::make_unique<MeridianReflector<Offsets + 1>>(profile), true)) ||
   ...);
  return made;
}

}  // namespace

std::unique_ptr<Reflector> make_meridian_reflector(const Profile& profile) {
  return make(profile, std::make_integer_sequence<int, meridian::most_degree>{});
}

}  // namespace catoptric::cad
