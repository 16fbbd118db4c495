// The session's panels: what they show, and what comes of the user's choices there.
#include "host/preview/session.hpp"
#include "host/window/widgets.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace glim {
namespace {

constexpr float kWidestAperture = 0.05F;  // in radii of the scene

}  // namespace

std::vector<WindowLayer> Session::layers() const
{
    std::vector<WindowLayer> layers;
    for (const Aov aov : pictures_.layers()) {
        layers.push_back({aov});
    }
    layers.push_back({Aov::Radiance, true});
    return layers;
}

PanelChoices Session::chosen() const
{
    return {meter_.look().exposure,
            meter_.look().tone,
            layer(),
            viewpoint_ ? viewpoint_->index() : 0,
            pictures_.isEmpty() ? std::nullopt : viewpoint_->fieldOfView(),
            lens_.choices(),
            timeline_.choices(),
            denoises_,
            showsGuide_,
            pictureSize_,
            surface_ ? surface_->choices : SurfaceChoices(),
            {changes_.options(), dragsSun_},
            meter_.errorLayer().target()};
}

// Returns what the user wants to be chosen.
PanelChoices Session::layOutPanels(const PanelChoices& before)
{
    PanelChoices wanted = before;
    screen_.gui().frame(drawer_.windowSize(), [&] {
        fillBeside(drawer_.shown());
        const bool isThere = !pictures_.isEmpty();
        const float below = !isThere || panelLevel_ > 0 ? showMessages(messages_.lines()) : 0.0F;
        if (isThere && panelLevel_ == 1) {
            const PanelFigures shown = figures();
            wanted = showControls(shown, before);
            wanted.scene = showScene(shown.scene, before.scene);
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
    window_.setTitle("glim: " + messages_.stage + " for " + scene_.filename().string());
    layOutPanels(chosen());
    layOutPanels(chosen());
    screen_.present(drawer_.picture());
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
    if (wanted.fieldOfView != before.fieldOfView) {
        viewpoint_->setFieldOfView(*wanted.fieldOfView);
    }
    if (wanted.lens != before.lens) {
        const Pose pose = viewpoint_->pose();
        lens_.choose(wanted.lens, glm::length(pose.at - pose.from));
    }
    if (wanted.time != before.time) {
        timeline_.choose(wanted.time, Clock::now());
    }
    meter_.errorLayer().setTarget(wanted.target);
    denoises_ = wanted.denoises;
    showsGuide_ = wanted.showsGuide;
    dragsSun_ = wanted.scene.dragsSun;
    if (wanted.picture != before.picture) {
        chooseSize(wanted.picture);
    }
    if (wanted.undo) {
        undo();
    } else if (wanted.surface != before.surface) {
        changeSurface(before.surface, wanted.surface);
    } else if (wanted.scene.load != before.scene.load) {
        changes_.change(wanted.scene.load, action_);
    }
}

void Session::changeSurface(const SurfaceChoices& before, const SurfaceChoices& wanted)
{
    LoadOptions options = changes_.options();
    if (surface_) {
        for (const Edit& change : listEdits(*surface_, before, wanted)) {
            options.edits = withEdit(std::move(options.edits), change);
        }
        surface_->choices = wanted;
        surface_->choices.hides = surface_->choices.isolates = false;
    }
    if (surface_ && wanted.isolates) {
        for (const std::string& node : pictures_.file().pointersToOthers(pictures_.scene().scene, surface_->node)) {
            options.edits = withEdit(std::move(options.edits), hidingEdit(node));
        }
    }
    if (wanted.showsAll) {
        std::erase_if(options.edits, hides);
    }
    changes_.change(options, action_);
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
    if (!figures.errors.empty()) {
        figures.toTarget = describeTarget(meter_.errorLayer().target(), figures.errors.back(), picture.renderer().plan().pictureSamples(),
                                          picture.samplesPerSecond(), picture.isDone());
    }
    figures.canDenoise = pictures_.settings().halves;
    figures.denoising = describe(denoiser_, denoises_);
    figures.size = size();
    figures.sizes = choicesOfSize(firstSize_);
    figures.scale = picture.scale();
    figures.device = screen_.device().description().name;
    figures.layers = layers();
    for (const Camera& camera : viewpoint_->cameras()) {
        figures.cameras.push_back(camera.name);
    }
    if (canFocus()) {
        figures.widestAperture = std::max(kWidestAperture * static_cast<float>(viewpoint_->sceneRadius()), lens_.choices().radius);
    }
    figures.animations = timeline_.animations();
    const std::vector<Edit>& edits = changes_.options().edits;
    figures.surface = {surface_ ? surface_->name : "", surface_ && surface_->materialPointer, surface_ && surface_->nodePointer,
                       static_cast<std::size_t>(std::ranges::count_if(edits, hides))};
    const Scene& scene = pictures_.scene().scene;
    figures.scene = {scene.variants, maps_, scene.environment.has_value(), scene.environment && scene.environment->map};
    figures.changes = changes_.count();
    figures.canGuide = options_.guiding;
    return figures;
}

}  // namespace glim
