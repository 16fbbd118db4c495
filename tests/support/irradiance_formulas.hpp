// Irradiance from lights of radiance 1, on a point at the origin, in double. Numbers as in the literature they name.
#pragma once

#include <glm/glm.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace glim {

// Sphere of radius r around `center`, receiver with unit normal n outside it; also where the horizon cuts the sphere (Snyder
// 1996, in the form of Lagarde and de Rousiers 2014).
inline double computeSphereIrradiance(const glm::dvec3& center, double r, const glm::dvec3& n)
{
    const double d = glm::length(center), h = d / r;
    const double c = glm::dot(center, n) / d, s = std::sqrt(std::max(0.0, 1.0 - c * c));
    const double x = std::sqrt(h * h - 1.0);
    if (c * h >= 1.0) {
        return std::numbers::pi * c / (h * h);
    }
    const double y = s > 0.0 ? -x * c / s : 2.0;
    if (c * h <= -1.0 || std::abs(y) > 1.0) {
        return 0.0;
    }
    const double inside = s * std::sqrt(1.0 - y * y);
    return (c * std::acos(y) - x * inside) / (h * h) + std::atan(inside / x);
}

// Polygon above the horizon (Lambert 1760).
inline double computePolygonIrradiance(const std::vector<glm::dvec3>& corners, const glm::dvec3& n)
{
    double sum = 0.0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const glm::dvec3 a = glm::normalize(corners[i]), b = glm::normalize(corners[(i + 1) % corners.size()]);
        const glm::dvec3 axis = glm::cross(a, b);
        const double sine = glm::length(axis);
        sum += sine > 0.0 ? std::atan2(sine, glm::dot(a, b)) * glm::dot(axis, n) / sine : 0.0;
    }
    return 0.5 * std::abs(sum);
}

// Disk of radius r parallel to the receiver, its centre at height h and offset d.
inline double computeDiskIrradiance(double r, double h, double d)
{
    const double sum = h * h + d * d + r * r;
    return std::numbers::pi / 2.0 * (1.0 - (sum - 2.0 * r * r) / std::sqrt(sum * sum - 4.0 * r * r * d * d));
}

}  // namespace glim
