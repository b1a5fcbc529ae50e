// Maps the unit square to directions and triangles, each map with its density and its inverse.
// Directions are unit vectors in the tangent frame (z = normal). Source: Pharr, Jakob, Humphreys, "Physically
// Based Rendering", 4th ed. 2023, A.5. `cos_max` is the cosine of the cone's half-aperture, 0 for the whole
// hemisphere.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace hemibake {

// Samples uniformly in solid angle; u.x = 0 is the normal, u.x = 1 the rim, u.y the azimuth / 2π.
glm::dvec3 sample_uniform_hemisphere(const glm::dvec2& u, double cos_max = 0);
double uniform_hemisphere_pdf(double cos_max = 0);  // 1/sr
glm::dvec2 invert_uniform_hemisphere(const glm::dvec3& direction, double cos_max = 0);

// Samples with density proportional to the cosine to the normal.
glm::dvec3 sample_cosine_hemisphere(const glm::dvec2& u, double cos_max = 0);
double cosine_hemisphere_pdf(double cos_theta, double cos_max = 0);  // 1/sr
glm::dvec2 invert_cosine_hemisphere(const glm::dvec3& direction, double cos_max = 0);

// Samples a triangle uniformly: returns the barycentric coordinates of its corners 1 and 2 (corner 0 has the
// rest).
glm::dvec2 sample_uniform_triangle(const glm::dvec2& u);
double uniform_triangle_pdf();  // over the barycentric coordinates
glm::dvec2 invert_uniform_triangle(const glm::dvec2& barycentric);

}  // namespace hemibake
