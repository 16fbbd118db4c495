// The camera as the user moves it.
#pragma once

#include "host/preview/controls.hpp"

#include <optional>
#include <string>

namespace glim {

class Viewpoint {
public:
    // Camera `index` of `scene`, or where it was moved to.
    Viewpoint(std::size_t index, const std::optional<Pose>& pose) : index_(index), firstIndex_(index), pose_(pose) {}

    // The scene may be another one from now on; the camera stays where it was moved to.
    void enter(const Scene& scene);
    Camera camera() const;
    const Camera& fileCamera() const { return cameras_[index_]; }  // before it was moved
    const Bounds& bounds() const { return bounds_; }

    // False if the scene has no such camera.
    bool choose(std::size_t index);
    void reset();
    // From where it stands to somewhere else.
    template <class Move>
    void move(Move&& to)
    {
        pose_ = to(pose());
    }
    Pose pose() const;

    std::size_t index() const { return index_; }  // of the file's camera
    const std::optional<Pose>& moved() const { return pose_; }
    // A camera and its node, as JSON of a glTF file.
    std::string describeAsGltf() const;

private:
    std::vector<Camera> cameras_;
    glm::dvec3 origin_{0.0};
    Bounds bounds_;
    std::size_t index_, firstIndex_;
    std::optional<Pose> pose_;  // absent: the file's camera as it is
};

}  // namespace glim
