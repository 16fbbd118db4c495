// glTF files in which a node, its parent and a camera move by animation 0.
#pragma once

#include "tests/support/gltf_builder.hpp"

namespace glim::test {

// Node 0 is the parent of node 1, "mover", which has a triangle; node 2 has the camera.
class MovingFile : public GltfBuilder {
public:
    explicit MovingFile(const nlohmann::json& camera = {{"type", "perspective"}, {"perspective", {{"yfov", 0.8}, {"znear", 0.1}}}})
    {
        append("nodes", {{"name", "parent"}, {"children", {1}}});
        append("nodes", {{"name", "mover"}, {"mesh", addTriangleMesh()}});
        append("cameras", camera);
        append("nodes", {{"name", "eye"}, {"camera", 0}, {"translation", {0, 0, 5}}});
        document["scenes"][0]["nodes"] = {0, 2};
        append("animations", {{"samplers", nlohmann::json::array()}, {"channels", nlohmann::json::array()}});
    }

    void parent(const char* path, const std::vector<float>& times, const std::vector<float>& values) { add(0, path, times, values); }
    void move(const char* path, const std::vector<float>& times, const std::vector<float>& values, const char* interpolation = "LINEAR")
    {
        add(1, path, times, values, interpolation);
    }
    void moveCamera(const char* path, const std::vector<float>& times, const std::vector<float>& values) { add(2, path, times, values); }

    // In the dark, which loads faster.
    Scene scene(double at, const std::optional<Shutter>& shutter = std::nullopt) const
    {
        LoadOptions options;
        options.at = at;
        options.shutter = shutter;
        options.environment = BuiltInEnvironment::None;
        return load(*this, options);
    }

    // Of any node.
    void add(std::size_t node, const std::string& path, const std::vector<float>& times, const std::vector<float>& values,
             const char* interpolation = "LINEAR")
    {
        const std::size_t width = path == "rotation" ? 4 : 3;
        const std::size_t input = addAccessor(toBytes(times), kFloat, "SCALAR", times.size());
        const std::size_t output = addAccessor(toBytes(values), kFloat, width == 4 ? "VEC4" : "VEC3", values.size() / width);
        nlohmann::json& animation = document["animations"][0];
        animation["channels"].push_back({{"sampler", animation["samplers"].size()}, {"target", {{"node", node}, {"path", path}}}});
        animation["samplers"].push_back({{"input", input}, {"output", output}, {"interpolation", interpolation}});
    }
};

}  // namespace glim::test
