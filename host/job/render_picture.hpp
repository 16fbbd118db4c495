// Renders one picture of a session, in memory.
#pragma once

#include "host/job/scene_session.hpp"
#include "host/message.hpp"
#include "host/render/film_file.hpp"

#include <exception>
#include <functional>
#include <optional>
#include <string>

namespace glim {

// What a picture is of.
struct PictureFrame {
    FlatCamera camera;
    RenderSettings settings;
    std::string description;            // of the camera (film_camera.hpp)
    std::optional<Crop> crop;           // of the picture
    std::optional<LearnedGuide> guide;  // what there is to know of one, if --guiding asks; its settings have it too
    bool keepsGuide = false;            // that is from a checkpoint

    void setGuide(LearnedGuide learned);
};

// The session must be posed at the picture's time. Throws InputError for a camera that the scene lacks and for a picture that the device
// has no memory for. Has no guide.
PictureFrame framePicture(SceneSession& session, const RenderJob& options);
// Whether this guide, which is of the picture, says all that --guiding asks for.
bool answers(const LearnedGuide& guide, GuidingChoice choice);
// Learns the guide that --guiding asks for. An observer that ends it must end the picture.
void learnGuide(SceneSession& session, const RenderJob& options, PictureFrame& frame, const LearningObserver& observer);
// What the film's light groups take, if it has some.
void sayGroupMemory(const SceneSession& session, const RenderJob& options, const PictureFrame& frame);

// Adds what the film's file says besides its samples, so that the film can be made again from it.
void labelFilm(Film& film, const RenderJob& options, const PictureFrame& frame);

// In what a film is not of the picture, as in "its seed is 1, expected 0"; nothing if it is of it.
std::optional<Message> findOther(const Film& film, const SceneSession& session, const PictureFrame& frame, const RenderJob& options);

// Lets the renderer go on from a film of the picture, which `name` names in messages. Throws InputError if it cannot. Says what it does.
void resumeFrom(Renderer& renderer, StoredFilm stored, const MessagePart& name);

struct RenderedFilm {
    Film film;  // without a label
    std::optional<Checkpoint> checkpoint;
    bool isGood = false;     // the target is reached
    bool isUnknown = false;  // the render has ended because its error stays unknown
    std::optional<Denoising> denoising;
    std::exception_ptr denoisingError;  // to be thrown once the film is safe; null if there was none
};

// Renders until the settings, the observer or the target, if one is given, ends it, and denoises if the options ask for it.
// `keepsCheckpoint` is asked at the end.
RenderedFilm renderPicture(Renderer& renderer, const RenderJob& options, FilmDenoiser& denoiser, const RenderObserver& observer,
                           const std::function<bool()>& keepsCheckpoint);

// Says that the error of what was rendered stayed unknown, and why, if that ended the render.
void warnIfUnknown(const RenderedFilm& rendered);

}  // namespace glim
