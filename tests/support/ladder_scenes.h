#pragma once

#include <string>

/// Small scenes that together use every rung, source, kind of near field and way to a mirror; lengths and
/// irradiances marked for scaled_text().
namespace catoptric::test {

inline const std::string few_photons = R"(
[model]
photons = 1500
replicates = 3
most_photons = 100000
)";

/// Start A before the paper's target: tubes.
inline const std::string paper_scene = R"(
[source]
position = [0, 0, @50]
power = 0.0314
[reflector]
points = [[0, @100], [@50, @100], [@90, @50]]
weights = [1, 1.6, 1]
reflectance = 0.9
[near_field]
radius = @50
samples = 60
[target]
kind = "paraboloid"
focal_length = @50
[variables.w1]
step = 0.3
lower = 0.6
upper = 2.5
[variables.r2]
step = @8
lower = @70
upper = @130
)" + few_photons;

/// A source off the axis, a mirror that lets light through, a leaning rectangle: photons in space.
inline const std::string aside_scene = R"(
[source]
position = [@3, @1, @55]
power = 2
[reflector]
points = [[0, @100], [@50, @100], [@90, @50]]
reflectance = 0.8
transmittance = 0.1
[near_field]
shape = "rectangle"
center = [@10, 0, @-40]
normal = [0, 0.5, 0.8660254037844386]
along = [1, 0, 0]
width = @90
height = @70
samples = 60
)" + few_photons;

/// A cosine's power over a floor that reflects: rings.
inline const std::string floor_scene = R"(
[source]
position = [0, 0, @30]
power = 10
exponent = 1.5
[reflector]
points = [[0, @60], [@30, @60], [@60, @30]]
reflectance = 0.9
[near_field]
center = [0, 0, @-40]
radius = @120
samples = 60
real = true
reflectance = 0.5
)" + few_photons;

/// An extended source.
inline const std::string disc_scene = R"(
[source]
kind = "disc"
position = [0, 0, @50]
radius = @10
power = 10
[reflector]
points = [[0, @100], [@50, @100], [@100, @50]]
[near_field]
radius = @120
samples = 60
)" + few_photons;

/// No mirror: it is made from source, target and package.
inline const std::string nothing_scene = R"(
start = "tailored"
[source]
position = [0, 0, 0]
power = 10
[tailored]
points = 6
[constraints]
rim_radius_max = @60
height_max = @50
[near_field]
center = [0, 0, @-1000]
real = true
radius = @500
samples = 60
[target]
kind = "ring"
inner_radius = @200
outer_radius = @500
irradiance = %6
background = %1.5
[search]
metric = "relative-rmse"
method = "none"
)" + few_photons + "kernel_radius = @50\n";

}  // namespace catoptric::test
