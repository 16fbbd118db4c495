// The camera that the user moves.
#pragma once

#include "host/preview/controls.hpp"

#include <optional>
#include <string>

namespace glim {

class Viewpoint {
public:
    // Starts with the file's camera `index`, or with the camera placed by `pose`.
    Viewpoint(std::size_t index, const std::optional<Pose>& pose)
        : index_(index),
          firstIndex_(index),
          pose_(pose)
    {}

    // Takes the cameras of `scene`, also when it has been loaded again. A moved camera stays where it is.
    void enter(const Scene& scene);
    Camera camera() const;
    const std::vector<Camera>& cameras() const { return cameras_; }
    const Camera& fileCamera() const { return cameras_[index_]; }  // without the user's moves
    const Bounds& bounds() const { return bounds_; }

    // Returns to the file's camera `index`. Returns false if there is none.
    bool choose(std::size_t index);
    void reset();
    // `change` makes the new pose from the present one.
    template <class Change>
    void move(Change&& change)
    {
        pose_ = change(pose());
    }
    Pose pose() const;

    std::size_t index() const { return index_; }
    const std::optional<Pose>& moved() const { return pose_; }
    // The camera and its node as glTF.
    std::string describeAsGltf() const;

private:
    std::vector<Camera> cameras_;
    glm::dvec3 origin_{0.0};
    Bounds bounds_;
    std::size_t index_, firstIndex_;
    std::optional<Pose> pose_;  // absent: the camera was not moved
};

}  // namespace glim
