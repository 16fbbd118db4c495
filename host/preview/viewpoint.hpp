// The camera that the user moves, by gestures of the mouse and by keys.
#pragma once

#include "host/clock.hpp"
#include "host/preview/controls.hpp"
#include "host/window/gestures.hpp"

#include <optional>
#include <set>
#include <string>

namespace glim {

class Viewpoint {
public:
    using Time = Clock::time_point;

    // Starts with the file's camera `index`, or with the camera placed by `pose`. All cameras have `field` and `projection`, but for what
    // orthographic ones cannot have: an angle, a K, a distortion.
    Viewpoint(std::size_t index, const std::optional<Pose>& pose, const FieldOfView& field = {}, const Projection& projection = {})
        : index_(index),
          firstIndex_(index),
          pose_(pose),
          field_(field),
          projection_(projection)
    {}

    // Takes the cameras of `scene`, also when it has been loaded again. A moved camera stays where it is.
    void enter(const Scene& scene);
    // Of a picture of this size, in pixels.
    Camera camera(const glm::uvec2& size) const;
    const std::vector<Camera>& cameras() const { return cameras_; }

    // Returns to the file's camera `index`. Returns false if there is none.
    bool choose(std::size_t index);
    void reset();
    void move(const Pose& pose);
    // The vertical field of view in degrees; nothing of a camera that has none to choose.
    std::optional<double> fieldOfView() const;
    void setFieldOfView(double degrees);
    // Moves as the gesture says, in a picture of this height in pixels. A click moves nothing.
    void follow(const Gesture& gesture, double height);
    // Takes the keys that move the camera: F frames the scene, in a picture of this aspect ratio, R resets, and others fly while they are
    // held. Returns whether `key` is one of them.
    bool press(char key, double aspectRatio);
    void release(char key) { held_.erase(key); }
    void releaseAll() { held_.clear(); }
    bool isFlying() const { return !held_.empty(); }
    // Flies from the time of the last call until `now`, by half the scene's radius a second.
    void fly(Time now);

    // Whether the camera has moved since the last call of see().
    bool hasMoved() const { return moved_; }
    void see() { moved_ = false; }

    Pose pose() const;
    double sceneRadius() const { return bounds_.radius; }
    // The field that the options give this camera: an orthographic one has no angle.
    FieldOfView field() const { return fieldOf(cameras_[index_]); }
    std::size_t index() const { return index_; }
    const std::optional<Pose>& moved() const { return pose_; }
    // The camera and its node as glTF.
    std::string describeAsGltf() const;

private:
    FieldOfView fieldOf(const Camera& camera) const;
    Camera zoomed() const;
    Camera placed() const;

    std::vector<Camera> cameras_;  // without the options' zoom, which is that of the pose once it moves
    glm::dvec3 origin_{0.0};
    BoundingSphere bounds_;
    std::size_t index_, firstIndex_;
    std::optional<Pose> pose_;  // absent: the file's camera was not moved
    FieldOfView field_;
    Projection projection_;
    bool moved_ = false;
    std::set<char> held_;
    Time flown_;
};

}  // namespace glim
