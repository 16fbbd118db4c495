// The preview's rendering thread: hands the user's input to the parts that answer it, renders, and presents pictures.
#pragma once

#include "host/clock.hpp"
#include "host/job/shown_options.hpp"
#include "host/preview/film_meter.hpp"
#include "host/preview/guide_inset.hpp"
#include "host/preview/guide_learner.hpp"
#include "host/preview/idle_denoiser.hpp"
#include "host/preview/lens_control.hpp"
#include "host/preview/pacer.hpp"
#include "host/preview/panels.hpp"
#include "host/preview/pick.hpp"
#include "host/preview/picture_drawer.hpp"
#include "host/preview/picture_size.hpp"
#include "host/preview/picture_writer.hpp"
#include "host/preview/preview.hpp"
#include "host/preview/scene_changes.hpp"
#include "host/preview/scene_loader.hpp"
#include "host/preview/scene_pictures.hpp"
#include "host/preview/shader_loader.hpp"
#include "host/preview/timeline.hpp"
#include "host/preview/viewpoint.hpp"
#include "host/window/gestures.hpp"
#include "host/window/screen.hpp"

#include <deque>
#include <functional>

namespace glim {

class Session {
public:
    Session(Window& window, EventQueue& events, const PreviewOptions& options);

    // Runs until the window is closed or all frames are shown.
    void run();
    // Prints how many pictures were shown and how long the user waited for them.
    void printSummary() const;

private:
    // Whether the picture under way is not that of the present camera, lens, scene and time.
    bool hasMoved() const { return !pictures_.isEmpty() && (viewpoint_->hasMoved() || wantedScene() != pictures_.options() || !hasLens()); }
    LoadOptions wantedScene() const;
    // Whether the next picture is another one without any input.
    bool movesItself() const { return timeline_.isPlaying() || (viewpoint_ && viewpoint_->isFlying()); }
    bool hasLens() const;
    bool canFocus() const;
    bool isWhole() const { return !hasMoved() && pictures_.shown().sampleCount() > 0; }
    bool isInputWaiting() const { return hasMoved() || !inbox_.empty() || !events_.isEmpty(); }
    bool showsGuide() const { return showsGuide_ && !pictures_.isEmpty() && panelLevel_ < 2; }
    // Nothing beside the picture.
    std::optional<glm::uvec2> pixelAt(const glm::dvec2& position) const { return glim::pixelAt(drawer_.viewport(), position, size()); }
    glm::uvec2 size() const { return drawer_.size(); }  // of the picture

    // The loop.
    void takeEvents(double seconds);
    void takeScene();
    void takeShaders();
    void enter(std::unique_ptr<LoadedScene> loaded);
    void exchange(std::unique_ptr<LoadedScene> loaded);
    void step();
    void follow();
    void followScene();
    void show();
    void begin();
    bool work();
    bool awaitsGuide() const;
    bool learnGuide();
    const IdleDenoiser::Result* shownDenoised() const;
    bool isPresentDue() const;
    void present();
    void reportShown();

    // The user's actions.
    void handle(const Event& event);
    void handleMouse(const Event& event);
    void press(char key);
    void pressForScene(char key);
    std::vector<WindowLayer> layers() const;
    WindowLayer layer() const { return {pictures_.layer(), meter_.errorLayer().isShown()}; }
    void chooseLayer(const WindowLayer& layer);
    void chooseCamera(std::size_t index);
    void toggleGuide();
    void play();
    void aimFocus();
    void focusOn(const std::optional<Pick>& found);
    void clickAt(const glm::dvec2& position);
    ShownPicture shown() const;
    void printOptions();
    void renewSurface();
    void undo();
    void writePictures();
    void say(const std::string& text);   // shows the text in the window
    void tell(const std::string& text);  // shows the text in the window and prints it to stderr

    // What is dropped on the window.
    void drop(const std::filesystem::path& file);
    void takeDropped();
    void enterDropped(std::unique_ptr<LoadedScene> loaded);

    // The picture's size.
    void chooseSize(const PictureSize& wanted);
    void resize();
    void lay(const glm::uvec2& window);
    void checkPicture(const PreparedScene& prepared, const glm::uvec2& size) const;

    // The panels over the picture.
    PanelChoices chosen() const;
    PanelChoices layOutPanels(const PanelChoices& before);
    void buildPanels();
    void changeSurface(const SurfaceChoices& before, const SurfaceChoices& wanted);
    void announceCompiling();
    PanelFigures figures() const;

    Window& window_;
    EventQueue& events_;
    const PreviewOptions& options_;
    Screen screen_;
    PictureDrawer drawer_;
    PictureSize firstSize_, pictureSize_;
    std::filesystem::path scene_;
    std::unique_ptr<SceneLoader> loader_;   // of the present scene
    std::unique_ptr<SceneLoader> dropped_;  // of one that was dropped and is not there yet; null: none
    std::optional<ShaderLoader> shaders_;
    PictureWriter writer_;

    ScenePictures pictures_;
    GuideLearner learner_;
    std::optional<Viewpoint> viewpoint_;  // absent until there is a scene
    LensControl lens_;
    Timeline timeline_;
    IdleDenoiser denoiser_;
    bool denoises_ = true;
    FilmMeter meter_;
    Pacer pacer_;
    PanelMessages messages_;

    SceneChanges changes_;
    std::vector<std::filesystem::path> maps_;  // that the environment may be
    bool dragsSun_ = false;
    std::uint64_t action_ = 0;  // of the user: keys and buttons that went down
    Picker picker_;
    std::optional<ChosenSurface> surface_;  // that was clicked
    GuideInset guideInset_;
    bool showsGuide_ = false;
    std::optional<glm::dvec2> mouse_;  // where it was last over the picture

    std::deque<Event> inbox_;      // events that are taken but not handled yet
    std::function<void()> later_;  // work that starts once the window shows the message about it
    bool writes_ = false;          // a picture is to be written once it is complete
    Gestures gestures_;
    bool mouseIsPanels_ = false;  // since the last event of the mouse
    bool paused_ = false, closing_ = false;
    int panelLevel_ = 1;  // 0: nothing, 1: controls, 2: keys
    std::uint64_t handledEvents_ = 0, frames_ = 0;
};

}  // namespace glim
