#pragma once

#include <optional>

#include "base/profile.h"
#include "cad/export.h"
#include "design/settings.h"

namespace catoptric::design {

/// Writes the defaults of the mirror as a part in: its wall, flange and material.
/// @fails InputError for a key that says nothing without another, and where an opening cannot be cut
void complete_part(Settings& settings);

/// Radius of the lamp opening, mm; nothing where none is asked for.
/// @in    profile  from which it will be cut
/// @fails InputError when it cannot be cut from that mirror
std::optional<double> opening_mm(const Settings& settings, double unit_mm, const Profile& profile);

/// What exchange files are to hold, of complete settings.
cad::ExportOptions export_options(const Settings& settings, double unit_mm);

/// Refuses a flange for which the mirror has no place, where there is one for its wall.
/// @in    profile  the mirror as it is exported, its opening cut
/// @fails InputError
/// @cost  some ms where there is a flange
void check_flange(const Settings& settings, const cad::ExportOptions& options, const Profile& profile);

}  // namespace catoptric::design
