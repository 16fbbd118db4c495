#include "host/scene/read_camera_file.hpp"

#include "host/error.hpp"
#include "host/scene/gltf/gltf_container.hpp"
#include "host/scene/gltf/gltf_schema.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace glim {
namespace {

using nlohmann::json;
using std::numbers::pi;

class EntryReader {
public:
    EntryReader(const std::string& file, std::size_t index, const json& entry)
        : file_(file),
          place_("[" + std::to_string(index) + "]"),
          entry_(entry)
    {}

    CameraEntry read() const
    {
        checkMembers();
        CameraEntry result;
        if (entry_.contains("camera")) {
            result.camera = readCamera();
        }
        if (entry_.contains("matrix")) {
            result.pose = computePose(readNumbers<16>("matrix"));
        } else if (entry_.contains("from")) {
            result.pose = readPose();
        }
        if (entry_.contains("yfov")) {
            result.yfov = readNumber("yfov");
            if (!(*result.yfov > 0.0 && *result.yfov < pi)) {
                refuse(MessageId::OutOfRange, {part::place(place_ + ".yfov"), " is ", part::value(entry_["yfov"].dump()), "; expected ",
                                               part::expected("radians between 0 and pi")});
            }
        }
        return result;
    }

private:
    [[noreturn]] void refuse(MessageId id, std::initializer_list<MessagePart> words) const
    {
        const Message message(id, words);
        throw InputError(Message(message, {part::file(file_), ": ", message.sentence, "."}));
    }

    void checkMembers() const
    {
        if (!entry_.is_object()) {
            refuse(MessageId::WrongType,
                   {part::place(place_), " is ", part::value(entry_.dump().substr(0, 40)), "; expected ", part::expected("an object")});
        }
        constexpr std::array kMembers{"camera", "from", "at", "up", "zoom", "matrix", "axes", "yfov"};
        for (const auto& [name, value] : entry_.items()) {
            if (std::find(kMembers.begin(), kMembers.end(), name) == kMembers.end()) {
                refuse(MessageId::UnknownName, {part::place(place_), " has a member \"", part::value(name), "\"; expected ",
                                                part::expected("camera, from, at, up, zoom, matrix, axes or yfov")});
            }
        }
        if (entry_.contains("from") != entry_.contains("at")) {
            refuse(MessageId::Requires,
                   {part::place(place_), " has only one of ", part::value("from and at"), "; expected ", part::expected("both")});
        }
        if (entry_.contains("matrix") && entry_.contains("from")) {
            refuse(MessageId::Conflict,
                   {part::place(place_), " has both ", part::value("matrix and from"), "; expected ", part::expected("one of them")});
        }
        for (const char* member : {"up", "zoom"}) {
            if (entry_.contains(member) && !entry_.contains("from")) {
                refuse(MessageId::Requires, {part::place(place_), " has a member \"", part::value(member), "\" without from; expected ",
                                             part::expected("from and at with it")});
            }
        }
        if (entry_.contains("axes") && !entry_.contains("matrix")) {
            refuse(MessageId::Requires, {part::place(place_), " has a member \"", part::value("axes"), "\" without matrix; expected ",
                                         part::expected("a matrix with them")});
        }
        if (entry_.contains("zoom") && entry_.contains("yfov")) {
            refuse(MessageId::Conflict,
                   {part::place(place_), " has both ", part::value("zoom and yfov"), "; expected ", part::expected("one of them")});
        }
    }

    std::string readCamera() const
    {
        const json& camera = entry_["camera"];
        if (camera.is_number_unsigned()) {
            return std::to_string(camera.get<std::uint64_t>());
        }
        if (!camera.is_string()) {
            refuse(MessageId::WrongType, {part::place(place_ + ".camera"), " is ", part::value(camera.dump().substr(0, 40)), "; expected ",
                                          part::expected("a name or an index")});
        }
        return camera.get<std::string>();
    }

    double readNumber(const char* name) const
    {
        if (!entry_[name].is_number()) {
            refuse(MessageId::WrongType, {part::place(place_ + "." + name), " is ", part::value(entry_[name].dump().substr(0, 40)),
                                          "; expected ", part::expected("a number")});
        }
        return entry_[name].get<double>();
    }

    template <std::size_t N>
    std::array<double, N> readNumbers(const char* name) const
    {
        const json& value = entry_[name];
        std::array<double, N> numbers{};
        bool valid = value.is_array() && value.size() == N;
        for (std::size_t i = 0; valid && i < N; ++i) {
            valid = value[i].is_number() && std::isfinite(value[i].get<double>());
            numbers[i] = valid ? value[i].get<double>() : 0.0;
        }
        if (!valid) {
            refuse(MessageId::WrongType, {part::place(place_ + "." + name), " is ", part::value(value.dump().substr(0, 40)), "; expected ",
                                          part::expected(std::to_string(N) + " finite numbers")});
        }
        return numbers;
    }

    glm::dvec3 readPoint(const char* name) const
    {
        const auto [x, y, z] = readNumbers<3>(name);
        return {x, y, z};
    }

    Pose readPose() const
    {
        Pose pose;
        pose.from = readPoint("from");
        pose.at = readPoint("at");
        pose.up = entry_.contains("up") ? readPoint("up") : pose.up;
        pose.zoom = entry_.contains("zoom") ? readNumber("zoom") : pose.zoom;
        if (!(pose.zoom > 0.0 && std::isfinite(pose.zoom))) {
            refuse(MessageId::OutOfRange, {part::place(place_ + ".zoom"), " is ", part::value(entry_["zoom"].dump()), "; expected ",
                                           part::expected("a number above 0")});
        }
        return pose;
    }

    bool isOpenCv() const
    {
        if (!entry_.contains("axes")) {
            return false;
        }
        const json& axes = entry_["axes"];
        if (axes != "gltf" && axes != "opencv") {
            refuse(MessageId::UnknownName, {part::place(place_ + ".axes"), " is ", part::value(axes.dump().substr(0, 40)), "; expected ",
                                            part::expected("\"gltf\" or \"opencv\"")});
        }
        return axes == "opencv";
    }

    // A glTF camera looks along its -z, and its +y is up.
    Pose computePose(const std::array<double, 16>& m) const
    {
        const double sign = isOpenCv() ? -1.0 : 1.0;
        const glm::dvec3 up = sign * glm::dvec3(m[4], m[5], m[6]), backward = sign * glm::dvec3(m[8], m[9], m[10]);
        if (!(glm::length(glm::cross(up, backward)) > 0.0) || glm::length(glm::dvec4(m[3], m[7], m[11], m[15] - 1.0)) > kAffineRounding) {
            refuse(MessageId::Degenerate, {part::place(place_ + ".matrix"), " is not the pose of a camera; expected ",
                                           part::expected("axes that differ and a last row of 0, 0, 0, 1")});
        }
        Pose pose;
        pose.from = {m[12], m[13], m[14]};
        pose.at = pose.from - glm::normalize(backward);
        pose.up = up;
        return pose;
    }

    const std::string& file_;
    std::string place_;
    const json& entry_;
};

}  // namespace

std::vector<CameraEntry> readCameraFile(const std::filesystem::path& file)
{
    const std::vector<unsigned char> bytes = readBytes(file);
    const json document = parseJson(file.string(), std::string(bytes.begin(), bytes.end()));
    if (!document.is_array() || document.empty()) {
        throw InputError(MessageId::WrongType,
                         {part::file(file.string()), ": expected ", part::expected("an array of at least one camera"), "."});
    }
    std::vector<CameraEntry> entries;
    for (std::size_t i = 0; i < document.size(); ++i) {
        entries.push_back(EntryReader(file.string(), i, document[i]).read());
    }
    return entries;
}

}  // namespace glim
