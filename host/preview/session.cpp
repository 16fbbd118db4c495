#include "host/preview/session.hpp"

#include "host/error.hpp"
#include "host/flatten/camera_options.hpp"
#include "host/memory.hpp"
#include "host/message.hpp"
#include "host/preview/pick.hpp"
#include "host/render/check_memory.hpp"
#include "host/text.hpp"
#include "host/window/widgets.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <iostream>
#include <utility>
#include <vector>

namespace glim {
namespace {

constexpr double kIdleSeconds = 0.05;
constexpr double kExposureStep = 0.5;  // stops

}  // namespace

Session::Session(Window& window, EventQueue& events, const PreviewOptions& options)
    : window_(window),
      events_(events),
      options_(options),
      screen_(window, options.device),
      display_(screen_.device()),
      loader_(options.scene, options.load, options.split),
      pictures_(screen_.device(), options.settings, options.lens, [this] { announceCompiling(); }),
      denoiser_(screen_.device(), [this] { announceCompiling(); }),
      meter_(options.look),
      guideInset_(screen_.device())
{
    display_.resize(std::max(1U, window.pictureSize().x), std::max(1U, window.pictureSize().y));
}

void Session::run()
{
    while (!closing_ && (!options_.frames || frames_ < *options_.frames)) {
        const bool isWorking = !pictures_.isEmpty() && work();
        const bool isFlying = viewpoint_ && viewpoint_->isFlying();
        takeEvents(isWorking || isFlying || pacer_.isChanged() || !inbox_.empty() ? 0.0 : kIdleSeconds);
        takeScene();
        if (const auto report = writer_.takeReport(false)) {
            tell(*report);
        }
        if (messages_.notice.expire()) {
            pacer_.change();
        }
        if (viewpoint_ && pacer_.isShown()) {
            viewpoint_->fly(Clock::now());  // one step per picture
        }
        followCamera();
        if (isPresentDue()) {
            present();
            followCamera();
        }
        if (later_ && !hasMoved() && !pictures_.shown().isFresh()) {
            std::exchange(later_, nullptr)();
        }
        if (writes_ && isWhole()) {
            writePictures();
        }
    }
    window_.finish();
    if (writes_) {
        tell("the window was closed before the picture was whole, and nothing is written");
    }
    if (const auto report = writer_.takeReport(true)) {
        tell(*report);
    }
}

// While long work is announced but not done, events wait.
void Session::takeEvents(double seconds)
{
    for (const Event& event : events_.take(seconds)) {
        inbox_.push_back(event);
    }
    while (!inbox_.empty() && !later_) {
        handle(inbox_.front());
        inbox_.pop_front();
        ++handledEvents_;
    }
    if (!pacer_.isChanged()) {
        reportShown();
    }
}

// A scene that is refused, or that needs too much memory, ends the session only if no other scene is loaded. (A lost device fails
// again in the next pass.)
void Session::takeScene()
{
    try {
        if (std::unique_ptr<LoadedScene> loaded = loader_.take()) {
            enter(std::move(loaded));
            messages_.trouble.clear();
        }
    } catch (const std::exception& error) {
        if (pictures_.isEmpty()) {
            throw;
        }
        const bool isMemory = dynamic_cast<const std::bad_alloc*>(&error) != nullptr;
        messages_.trouble = isMemory ? options_.scene.string() + ": " + memorySentence() : error.what();
        tell(messages_.trouble);
    }
    const std::string stage = loader_.stage();
    if (stage != messages_.stage) {
        messages_.stage = stage;
        window_.setTitle("glim: " + (stage.empty() ? options_.scene.filename().string() : stage));
        pacer_.change();
    }
}

// All that depends on the scene. What may refuse it comes first.
void Session::enter(std::unique_ptr<LoadedScene> loaded)
{
    const PreparedScene& prepared = loaded->prepared;
    RenderSettings settings = options_.settings;
    settings.width = display_.width();
    settings.height = display_.height();
    checkMemory(prepared, settings, screen_.device().description());
    if (!viewpoint_) {
        const Camera& chosen = findCamera(prepared.scene, options_.camera);
        sayIfCameraIsNumber(prepared.scene, options_.camera);
        applyField(chosen, options_.field);                                        // refuses an angle for an orthographic camera,
        const Camera seen = applyProjection(chosen, options_.projection, size());  // and a K
        if (options_.pose) {
            placeCamera(chosen, *options_.pose, prepared.scene.origin);  // refuses a pose without direction
        }
        viewpoint_.emplace(static_cast<std::size_t>(&chosen - prepared.scene.cameras.data()), options_.pose, options_.field,
                           options_.projection);
        if (!options_.size) {
            window_.setSize(defaultSize(seen));
        }
    }
    warnIfNoLights(prepared);
    meter_.enter(prepared.scene);
    learner_.end();
    const bool isFirst = pictures_.isEmpty();
    pictures_.enter(std::move(loaded));
    surface_.reset();
    viewpoint_->enter(pictures_.scene().scene);
    if (!isFirst) {
        tell(options_.scene.string() + " has changed and is loaded again");
    }
    show();
}

// What is refused is said, and the scene stays as it was.
void Session::edit(const std::vector<Edit>& edits)
{
    const std::vector<Edit> all = joinEdits(options_.load.edits, edits);
    learner_.end();
    try {
        pictures_.edit(all, options_.load.at, options_.split);
    } catch (const InputError& error) {
        tell(error.what());
        return;
    }
    edits_ = edits;
    loader_.setEdits(all);
    viewpoint_->enter(pictures_.scene().scene);
    show();
}

void Session::resize()
{
    const glm::uvec2 wanted = window_.pictureSize();
    if (wanted.x == 0 || wanted.y == 0 || wanted == size()) {
        return;
    }
    display_.resize(wanted.x, wanted.y);
    if (!pictures_.isEmpty()) {
        show();
    }
}

// Begins the next picture only after the last one was shown. Otherwise a user who moves without rest would see none.
void Session::followCamera()
{
    if (hasMoved() && pacer_.isShown()) {
        show();
    }
}

// Begins a new picture with the present camera.
void Session::show()
{
    learner_.cancel();
    pictures_.show(viewpoint_->camera(size()), size());
    begin();
}

void Session::begin()
{
    viewpoint_->see();
    meter_.restart();
    denoiser_.restart();
    pacer_.begin();
}

// Whether the picture is still to begin anew, by a guide that is learned once the view rests.
bool Session::awaitsGuide() const { return options_.guiding && !pictures_.isGuided() && pictures_.layer() != Aov::BvhSteps; }

// Works on the guide for about a tenth of a second. Returns false if there is nothing to do.
bool Session::learnGuide()
{
    if (hasMoved()) {
        return false;  // show() comes first
    }
    if (const std::shared_ptr<const Guide> guide = learner_.take()) {
        pictures_.guide(guide, viewpoint_->camera(size()), size());
        begin();
        say("guided by " + counted(guide->cells, "cell"));
        return true;
    }
    if (!learner_.isWorking() && awaitsGuide() && !paused_ && pictures_.shown().isAlone()) {
        announceCompiling();
        learner_.begin(pictures_.shown().renderer(), pictures_.scene().flat, pictures_.shown().camera());
        pacer_.change();
    }
    return learner_.advance();
}

bool Session::work()
{
    if (learnGuide()) {
        return true;
    }
    const auto shouldContinue = [this] { return !isInputWaiting(); };
    const bool denoises = denoises_ && options_.settings.halves && pictures_.layer() == Aov::Radiance;
    const bool worked =
        (denoises && denoiser_.work(pictures_.shown(), shouldContinue)) || pictures_.shown().refine(paused_, shouldContinue);
    if (worked) {
        pacer_.change();
    }
    return worked;
}

bool Session::isPresentDue() const
{
    const bool isThere = !pictures_.isEmpty();
    const bool nothingNew = !pacer_.isChanged() && !options_.frames;
    if (nothingNew || (isThere && pictures_.shown().isFresh())) {
        return false;
    }
    return pacer_.isDue(Clock::now(), isThere && pictures_.shown().scale() > 1);
}

void Session::present()
{
    const Clock::time_point start = Clock::now();
    if (!pictures_.isEmpty()) {
        meter_.measure(pictures_.shown(), pictures_.layer(), isInputWaiting());
        if (const IdleDenoiser::Result* denoised = shownDenoised()) {
            drawDenoised(*denoised);
        } else {
            display_.draw(pictures_.shown().renderer(), pictures_.layer(), meter_.range(), meter_.look());
        }
    }
    if (showsGuide()) {
        const std::optional<glm::uvec2> pixel = mouse_ ? std::optional(pixelAt(*mouse_)) : std::nullopt;
        guideInset_.look(pictures_.shown(), pictures_.scene(), picker_, pixel, size());
    }
    buildPanels();
    buildPanels();  // ImGui lays out a frame by the sizes of the one before
    const bool isShown = screen_.present(shownPicture());
    pacer_.spend(start, Clock::now());
    if (isShown) {
        pacer_.show(hasMoved());
        frames_ += pictures_.isEmpty() ? 0 : 1;
        reportShown();
    }
}

const IdleDenoiser::Result* Session::shownDenoised() const
{
    return denoises_ && !pictures_.isEmpty() && pictures_.layer() == Aov::Radiance ? denoiser_.result() : nullptr;
}

const StorageImage& Session::shownPicture() const
{
    const IdleDenoiser::Result* denoised = shownDenoised();
    return denoised != nullptr && denoised->version == painted_ ? painter_->picture() : display_.picture();
}

void Session::drawDenoised(const IdleDenoiser::Result& denoised)
{
    if (!painter_) {
        painter_.emplace(screen_.device());
    }
    if (std::exchange(painted_, denoised.version) != denoised.version) {
        painter_->resize(size());
        painter_->setValues(denoised.picture.radiance);
    }
    ViewPass pass{};
    pass.right = size().x;
    pass.bottom = size().y;
    pass.shownAs = kShownAsColor;
    pass.scale = static_cast<float>(std::exp2(meter_.look().exposure));
    pass.tone = static_cast<std::uint32_t>(meter_.look().tone);
    painter_->draw(pass);
}

void Session::reportShown()
{
    if (!pictures_.isEmpty() && !hasMoved()) {
        const Refiner& picture = pictures_.shown();
        const bool isLast = !awaitsGuide();
        window_.reportShown(isLast ? picture.sampleCount() : 0, isLast && picture.scale() == 1 && picture.isDone(), handledEvents_);
    }
}

void Session::say(const std::string& text)
{
    messages_.notice.show(text);
    pacer_.change();
}

void Session::tell(const std::string& text)
{
    glim::say(MessageId::WindowReport, {text});
    say(text);
}

void Session::handle(const Event& event)
{
    using Kind = Event::Kind;
    switch (event.kind) {
    case Kind::Close: closing_ = true; break;
    case Kind::Resize:
        resize();
        pacer_.change();
        break;
    case Kind::KeyUp:
        if (viewpoint_) {
            viewpoint_->release(event.key);
        }
        break;
    case Kind::FocusLost:
        if (viewpoint_) {
            viewpoint_->releaseAll();
        }
        gestures_.cancel();
        screen_.gui().point(event);
        break;
    case Kind::KeyDown:
        pacer_.await(event.when);
        press(event.key);
        break;
    default: handleMouse(event);
    }
}

// The panels take what is theirs. The mouse may move over the picture without any answer, unless it asks the guide.
void Session::handleMouse(const Event& event)
{
    screen_.gui().point(event);
    buildPanels();
    const bool panels = screen_.gui().hasMouse();
    const std::optional<Gesture> gesture = gestures_.take(event, panels);
    if (!panels) {
        mouse_ = event.position;
    }
    if (panels || gesture || mouseIsPanels_ || (showsGuide() && pictures_.isGuided())) {
        pacer_.await(event.when);
    }
    mouseIsPanels_ = panels;
    if (gesture && gesture->kind == Gesture::Kind::Click) {
        clickAt(gesture->position);
    } else if (gesture && viewpoint_) {
        viewpoint_->follow(*gesture, static_cast<double>(display_.height()));
    }
}

void Session::press(char key)
{
    if (key == kEscape) {
        closing_ = true;
    } else if (key == 'H') {
        panelLevel_ = (panelLevel_ + 1) % 3;
    } else if (key == '+' || key == '-') {
        meter_.setExposure(meter_.look().exposure + (key == '+' ? kExposureStep : -kExposureStep));
    } else if (key == 'T') {
        meter_.setTone(static_cast<Tone>((static_cast<std::uint32_t>(meter_.look().tone) + 1) % 3));
    } else if (key == 'N') {
        denoises_ = !denoises_;
    } else if (key == 'G') {
        toggleGuide();
    } else if (key == ' ') {
        paused_ = !paused_;
    } else if (viewpoint_) {
        pressForScene(key);
    }
}

void Session::pressForScene(char key)
{
    if (viewpoint_->press(key, static_cast<double>(display_.width()) / static_cast<double>(display_.height()))) {
        return;
    }
    if (key >= '1' && key <= '9') {
        chooseCamera(static_cast<std::size_t>(key - '1'));
    } else if (key == 'V') {
        const std::vector<Aov> order = pictures_.layers();
        const auto at = std::find(order.begin(), order.end(), pictures_.layer());
        chooseLayer(at + 1 == order.end() ? order.front() : at[1]);
    } else if (key == 'P') {
        say("writing the picture");
        if (isWhole()) {
            later_ = [this] { writePictures(); };
        } else {
            writes_ = true;
        }
    } else if (key == 'C') {
        printCamera();
    } else if (key == 'Z') {
        undo();
    }
}

void Session::toggleGuide()
{
    if (options_.guiding) {
        showsGuide_ = !showsGuide_;
    } else {
        say("There is no guide without --guiding on.");
    }
}

void Session::undo()
{
    if (edits_.empty()) {
        say("There is nothing to undo.");
    } else {
        edit({edits_.begin(), edits_.end() - 1});
    }
}

void Session::chooseLayer(Aov layer)
{
    if (pictures_.choose(layer, viewpoint_->camera(size()), size(), viewpoint_->hasMoved())) {
        begin();
    }
    meter_.renew();
}

void Session::chooseCamera(std::size_t index)
{
    if (!viewpoint_->choose(index)) {
        say("The file has no camera " + std::to_string(index + 1) + ".");
    }
}

PanelChoices Session::chosen() const
{
    return {meter_.look().exposure,
            meter_.look().tone,
            pictures_.layer(),
            viewpoint_ ? viewpoint_->index() : 0,
            denoises_,
            showsGuide_,
            surface_ ? choicesOf(*surface_, pictures_.scene().scene, pictures_.file()) : SurfaceChoices()};
}

// Returns what the user wants to be chosen.
PanelChoices Session::layOutPanels(const PanelChoices& before)
{
    PanelChoices wanted = before;
    screen_.gui().frame(size(), [&] {
        const bool isThere = !pictures_.isEmpty();
        const float below = !isThere || panelLevel_ > 0 ? showMessages(messages_.lines()) : 0.0F;
        if (isThere && panelLevel_ == 1) {
            wanted = showControls(figures(), before);
        }
        if (showsGuide()) {
            showGuide(guideInset_.map(), guideInset_.why());
        }
        if (panelLevel_ == 2) {
            showHelp(below);
        }
    });
    return wanted;
}

// The window answers nothing until the kernels are there. So it must say that before, over whatever picture it has.
void Session::announceCompiling()
{
    messages_.stage = "compiling kernels";  // takeScene() ends it
    window_.setTitle("glim: " + messages_.stage + " for " + options_.scene.filename().string());
    layOutPanels(chosen());
    layOutPanels(chosen());
    screen_.present(shownPicture());
}

void Session::buildPanels()
{
    const PanelChoices before = chosen(), wanted = layOutPanels(before);
    if (wanted.exposure != before.exposure) {
        meter_.setExposure(wanted.exposure);
    }
    if (wanted.tone != before.tone) {
        meter_.setTone(wanted.tone);
    }
    if (wanted.layer != before.layer) {
        chooseLayer(wanted.layer);
    }
    if (wanted.camera != before.camera) {
        chooseCamera(wanted.camera);
    }
    denoises_ = wanted.denoises;
    showsGuide_ = wanted.showsGuide;
    if (wanted.undo) {
        undo();
    } else if (surface_ && wanted.surface != before.surface) {
        std::vector<Edit> edits = edits_;
        for (const Edit& change : listEdits(*surface_, before.surface, wanted.surface)) {
            edits = withEdit(std::move(edits), change);
        }
        edit(edits);
    }
}

PanelFigures Session::figures() const
{
    Refiner& picture = pictures_.shown();
    PanelFigures figures;
    figures.samples = picture.renderer().plan().sampleCount();
    figures.seconds = picture.seconds();
    figures.samplesPerSecond = picture.samplesPerSecond();
    figures.state = paused_                                    ? "paused"
                    : learner_.isWorking()                     ? "learning a guide"
                    : picture.isDone() && picture.scale() == 1 ? "done"
                    : pictures_.isGuided()                     ? "guided"
                                                               : "";
    figures.errors = meter_.errors();
    figures.canDenoise = options_.settings.halves;
    figures.denoising = denoises_ ? describe(denoiser_) : std::vector<std::string>{};
    figures.size = size();
    figures.scale = picture.scale();
    figures.device = screen_.device().description().name;
    figures.layers = pictures_.layers();
    for (const Camera& camera : viewpoint_->cameras()) {
        figures.cameras.push_back(camera.name);
    }
    figures.surface = surface_ ? surface_->name : "";
    figures.hasMaterial = surface_ && surface_->materialPointer;
    figures.hasNode = surface_ && surface_->nodePointer;
    figures.edits = edits_.size();
    figures.canGuide = options_.guiding;
    return figures;
}

void Session::clickAt(const glm::dvec2& position)
{
    if (pictures_.isEmpty()) {
        return;
    }
    const glm::uvec2 pixel = pixelAt(position);
    const std::optional<Pick> found = picker_.pick(pictures_.shown(), pictures_.scene(), pixel, size());
    const std::string there = describeSurface(found);
    surface_.reset();
    if (found) {
        surface_ = chooseSurface(found->primitive, pictures_.scene().scene, pictures_.file());
    }
    std::cout << "pixel (" << pixel.x << ", " << pixel.y << ") of " << size().x << "x" << size().y << ": " << there
              << describeSamples(pictures_.shown(), pixel, pictures_.layer()) << std::endl;
    say(there);
}

void Session::printCamera()
{
    const std::string options = "--camera " + std::to_string(viewpoint_->index()) +
                                cameraOptions(viewpoint_->moved(), options_.field, options_.lens, options_.projection) + " --size " +
                                std::to_string(display_.width()) + "x" + std::to_string(display_.height()) +
                                editOptions(joinEdits(options_.load.edits, edits_));
    std::cout << options << '\n' << viewpoint_->describeAsGltf() << std::endl;
    say(options);
}

void Session::writePictures()
{
    Film film = pictures_.shown().renderer().film();
    film.sceneFile = options_.scene.string();
    film.showsBackground = options_.load.environmentBackground;
    film.identity.settings += describeCamera(viewpoint_->moved(), options_.field, options_.lens, options_.projection);
    if (const auto report = writer_.takeReport(true)) {
        tell(*report);
    }
    writes_ = false;
    meter_.expose(film, pictures_.layer());
    const IdleDenoiser::Result* denoised = shownDenoised();
    writer_.write(options_.scene, std::move(film), pictures_.layer(), meter_.look(),
                  denoised ? std::optional(denoised->picture) : std::nullopt);
}

void Session::printSummary() const
{
    const std::string waits = pacer_.latency().describe();
    glim::say(MessageId::WindowReport, {part::value(std::to_string(frames_)), " frames", waits.empty() ? "" : "; " + waits});
}

}  // namespace glim
