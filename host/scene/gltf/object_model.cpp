#include "host/scene/gltf/object_model.hpp"

#include <glm/glm.hpp>
#include <glm/gtc/matrix_access.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace glim {

using nlohmann::json;

namespace {

// ~1 is a slash, ~0 a tilde.
std::string unescape(std::string step)
{
    for (const auto& [code, character] : {std::pair("~1", "/"), {"~0", "~"}}) {
        for (std::size_t at = step.find(code); at != std::string::npos; at = step.find(code, at + 1)) {
            step.replace(at, 2, character);
        }
    }
    return step;
}

}  // namespace

std::vector<std::string> splitPointer(const std::string& pointer)
{
    std::vector<std::string> steps;
    for (std::size_t at = 0; at < pointer.size() && pointer[at] == '/';) {
        const std::size_t end = std::min(pointer.find('/', at + 1), pointer.size());
        steps.push_back(unescape(pointer.substr(at + 1, end - at - 1)));
        at = end;
    }
    return steps;
}

bool isIndex(const std::string& step) { return !step.empty() && step.find_first_not_of("0123456789") == std::string::npos; }

json* follow(json& at, const std::string& step)
{
    constexpr std::size_t kMaxDigits = 9;
    if (at.is_array() && isIndex(step) && step.size() <= kMaxDigits && std::stoul(step) < at.size()) {
        return &at[std::stoul(step)];
    }
    return at.is_object() && at.contains(step) ? &at[step] : nullptr;
}

std::string makeSchemaPath(const std::vector<std::string>& steps)
{
    std::string path;
    for (const std::string& step : steps) {
        if (step.find_first_of(".[]{}") != std::string::npos) {
            return "";
        }
        path += isIndex(step) ? "[]" : (path.empty() ? "" : ".") + step;
    }
    return path;
}

bool splitMatrix(json& node)
{
    constexpr double kOrthogonal = 1e-4;  // of columns of unit length
    const auto numbers = node["matrix"].get<std::vector<double>>();
    if (numbers.size() != 16) {
        return false;
    }
    const glm::dmat4 matrix = glm::make_mat4(numbers.data());
    if (glm::row(matrix, 3) != glm::dvec4(0.0, 0.0, 0.0, 1.0)) {
        return false;
    }
    glm::dmat3 axes(matrix);
    glm::dvec3 scale(glm::length(axes[0]), glm::length(axes[1]), glm::length(axes[2]));
    scale.x = glm::determinant(axes) < 0.0 ? -scale.x : scale.x;
    if (scale.x == 0.0 || scale.y == 0.0 || scale.z == 0.0) {
        return false;
    }
    for (int c = 0; c < 3; ++c) {
        axes[c] /= scale[c];
    }
    const glm::dvec3 cosines(glm::dot(axes[0], axes[1]), glm::dot(axes[1], axes[2]), glm::dot(axes[2], axes[0]));
    if (!(glm::length(cosines) <= kOrthogonal)) {
        return false;
    }
    const glm::dquat rotation = glm::quat_cast(axes);
    node.erase("matrix");
    node["translation"] = {matrix[3].x, matrix[3].y, matrix[3].z};
    node["rotation"] = {rotation.x, rotation.y, rotation.z, rotation.w};
    node["scale"] = {scale.x, scale.y, scale.z};
    return true;
}

}  // namespace glim
