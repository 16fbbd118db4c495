#include "host/scene/projection.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace glim {
namespace {

constexpr double kMaxTangent = 1e4;

// Whether the distance from the middle grows with the tangent r.
bool growsRadially(const std::array<double, 8>& d, double r)
{
    const auto& [k1, k2, p1, p2, k3, k4, k5, k6] = d;
    const double s = r * r;
    const double above = 1.0 + s * (k1 + s * (k2 + s * k3)), below = 1.0 + s * (k4 + s * (k5 + s * k6));
    const double aboveSlope = 2.0 * s * (k1 + s * (2.0 * k2 + s * 3.0 * k3)), belowSlope = 2.0 * s * (k4 + s * (2.0 * k5 + s * 3.0 * k6));
    return below > 0.0 && (above + aboveSlope) * below > above * belowSlope;
}

bool growsWithAngle(const std::array<double, 8>& d, double angle)
{
    const double s = angle * angle;
    return 1.0 + s * (3.0 * d[0] + s * (5.0 * d[1] + s * (7.0 * d[2] + s * 9.0 * d[3]))) > 0.0;
}

}  // namespace

double findEnd(const Projection& projection)
{
    const bool isFisheye = projection.model == Projection::Model::Fisheye;
    const auto grows = [&](double x) {
        return isFisheye ? growsWithAngle(projection.distortion, x) : growsRadially(projection.distortion, x);
    };
    // Steps that no hump of a measured lens fits into, then halved until they vanish.
    const double most = isFisheye ? std::numbers::pi : kMaxTangent;
    double end = 0.0, step = 1e-3;
    while (end < most && step > 1e-9) {
        const double next = std::min(end + std::max(step, end * step), most);
        if (grows(next)) {
            end = next;
        } else {
            step *= 0.5;
        }
    }
    return end * (1.0 - 1e-6);  // not beyond it when it is rounded to float32
}

}  // namespace glim
