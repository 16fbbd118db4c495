#include "host/view/view_session.hpp"

#include "host/error.hpp"
#include "host/measure/compare_images.hpp"
#include "host/measure/error_picture.hpp"
#include "host/message.hpp"
#include "host/text.hpp"
#include "host/window/widgets.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <utility>

namespace glim {
namespace {

constexpr double kIdleSeconds = 0.25;     // between looks at the files
constexpr double kExposureStep = 0.5;     // stops
constexpr double kNotchesToDouble = 4.0;  // of the wheel

template <class... Values>
std::string formatted(const char* format, Values... values)
{
    char text[256];
    std::snprintf(text, sizeof text, format, values...);
    return text;
}

DisplayRange joined(const DisplayRange& a, const DisplayRange& b) { return {std::min(a.low, b.low), std::max(a.high, b.high)}; }

}  // namespace

ViewSession::ViewSession(Window& window, EventQueue& events, const ViewOptions& options, ViewedFilms films)
    : window_(window),
      events_(events),
      films_(std::move(films)),
      screen_(window, options.device),
      gui_(screen_.gui()),
      painter_(screen_.device()),
      exposure_(options.look.exposure.value_or(0.0)),
      exposureIsAuto_(!options.look.exposure)
{
    tone_ = options.look.tone.value_or(Tone::None);
    lights_.assign(films_.lightGroups().size(), 1.0);
    painter_.resize(glm::max(window.pictureSize(), 1U));
    place(fit(films_.size(), painter_.size()));
    chooseLayer(0);
}

void ViewSession::run()
{
    auto looked = Clock::now();
    while (!closing_) {
        for (const Event& event : events_.take(changed_ ? 0.0 : kIdleSeconds)) {
            handle(event);
            ++handledEvents_;
        }
        if (secondsSince(looked) >= kIdleSeconds) {
            readChangedFilms();
            looked = Clock::now();
        }
        changed_ = notice_.expire() || changed_;
        if (changed_) {
            present();
        } else {
            window_.reportShown(0, true, handledEvents_);
        }
    }
}

void ViewSession::printSummary() const
{
    if (latency_.count() > 0) {
        say(MessageId::WindowReport, {latency_.describe()});
    }
}

void ViewSession::handle(const Event& event)
{
    using Kind = Event::Kind;
    switch (event.kind) {
    case Kind::Close: closing_ = true; break;
    case Kind::Resize:
        screen_.takeScale();
        resize();
        break;
    case Kind::KeyUp:
    case Kind::Drop: break;
    case Kind::KeyDown:
        waiting_.push_back(event.when);
        press(event.key);
        buildPanels();  // a hidden panel takes no clicks
        changed_ = true;
        break;
    case Kind::FocusLost:
        gestures_.cancel();
        gui_.point(event);
        break;
    default: handleMouse(event);
    }
}

// The panels take what is theirs. Each move of the mouse is answered: the panel shows the pixel under it.
void ViewSession::handleMouse(const Event& event)
{
    waiting_.push_back(event.when);
    changed_ = true;
    gui_.point(event);
    buildPanels();
    const bool isPanels = gui_.hasMouse();
    pointer_ = isPanels ? std::nullopt : std::optional(event.position);
    if (const std::optional<Gesture> gesture = gestures_.take(event, isPanels)) {
        follow(*gesture);
    }
}

void ViewSession::follow(const Gesture& gesture)
{
    switch (gesture.kind) {
    case Gesture::Kind::Orbit:
    case Gesture::Kind::Pan: place({viewport_.zoom, viewport_.corner + gesture.motion}); break;
    case Gesture::Kind::Dolly: place(zoomAt(viewport_, gesture.position, std::exp2(gesture.notches / kNotchesToDouble))); break;
    case Gesture::Kind::Click:
        if (const auto pixel = pixelAt(viewport_, gesture.position, films_.size())) {
            print(*pixel);
        }
        return;
    }
    isFitted_ = false;
}

void ViewSession::press(char key)
{
    ViewChoices wanted = shownChoices();
    if (key == kEscape) {
        closing_ = true;
    } else if (key == 'H') {
        panelLevel_ = (panelLevel_ + 1) % 3;
    } else if ((key == '+' || key == '-') && isExposed()) {
        wanted.exposure += key == '+' ? kExposureStep : -kExposureStep;
    } else if (key == 'T' && isToned()) {
        wanted.tone = static_cast<Tone>((static_cast<std::uint32_t>(tone_) + 1) % 3);
    } else if (key == 'L') {
        printLights();
    } else if (key == 'V') {
        wanted.layer = (layer_ + 1) % films_.layers().size();
    } else if (key == 'B') {
        const std::vector<Side> order = sides();
        const auto at = std::find(order.begin(), order.end(), side_);
        wanted.side = at + 1 == order.end() ? order.front() : at[1];
    } else if (key == 'F' || key == '1') {
        place(key == 'F' ? fit(films_.size(), painter_.size()) : actualSize(films_.size(), painter_.size()));
        isFitted_ = key == 'F';
    }
    change(wanted);
}

void ViewSession::resize()
{
    const glm::uvec2 size = window_.pictureSize();
    changed_ = true;
    if (size.x == 0 || size.y == 0 || size == painter_.size()) {
        return;
    }
    painter_.resize(size);
    place(isFitted_ ? fit(films_.size(), size) : viewport_);
}

void ViewSession::place(const Viewport& viewport)
{
    viewport_ = viewport;
    laid_ = drawn_ = false;
    changed_ = true;
}

// Takes the values of a layer.
void ViewSession::chooseLayer(std::size_t index)
{
    layer_ = index;
    const ViewedLayer& layer = films_.layers()[index];
    shown_ = {layer.of[0] ? *layer.of[0] : *layer.of[1], {}, {}};
    std::optional<DisplayRange> range;
    for (std::size_t i = 0; i < values_.size(); ++i) {
        values_[i] = layer.of[i] ? valuesOf(films_.image(i), *layer.of[i]) : Picture{};
        const bool isColor = layer.of[i] && layer.of[i]->isExposed;
        alphas_[i] = isColor ? alphaOf(films_.image(i)) : Picture{};
        const auto own = layer.of[i] ? getRange(films_.image(i), *layer.of[i], values_[i]) : std::nullopt;
        range = range && own ? joined(*range, *own) : own ? own : range;
    }
    shown_.range = range.value_or(DisplayRange{});
    if (exposureIsAuto_ && shown_.layer.isExposed) {
        exposure_ = chooseExposure(values_[layer.of[0] ? 0 : 1].radiance);
    }
    chooseSide(wantedSide_);
}

// A side that the layer lacks gives way to one that it has, until there is a layer that has it.
void ViewSession::chooseSide(Side side)
{
    wantedSide_ = side;
    const std::vector<Side> has = sides();
    side_ = std::find(has.begin(), has.end(), side) != has.end() ? side : has.front();
    laid_ = drawn_ = false;
    if (side_ == Side::Difference && !shown_.difference) {
        shown_.difference = measureDifference();
    }
}

// Colours differ relative to the reference, as in relMSE. Other layers have no such scale.
ViewSession::Shown::Difference ViewSession::measureDifference() const
{
    const bool isRelative = shown_.layer.shownAs == ShownAs::Color;
    Shown::Difference difference{isRelative ? 1.0 : 0.0, isRelative ? relativeEpsilon(values_[1]) : 1.0, 0.0, ""};
    difference.scale = chooseErrorScale(values_[0], values_[1], difference.relative, difference.epsilon);
    if (const auto errors = shown_.layer.isToned ? measureErrors(values_[0], values_[1]) : std::nullopt) {
        difference.error =
            formatted("relMSE %.3g, RMSE %.3g %% of the mean", errors->relMse, 100.0 * std::sqrt(errors->mse) / meanRadiance(values_[1]));
    }
    return difference;
}

void ViewSession::change(const ViewChoices& wanted)
{
    if (wanted.exposure != exposure()) {
        exposure() = wanted.exposure;
        exposureIsAuto_ = exposureIsAuto_ && side_ == Side::Difference;
        drawn_ = false;
    }
    if (wanted.tone != tone_) {
        tone_ = wanted.tone;
        drawn_ = false;
    }
    if (wanted.lights != lights_) {
        setLights(wanted.lights);
    }
    if (wanted.layer != layer_) {
        chooseLayer(wanted.layer);
    } else if (wanted.side != side_) {
        chooseSide(wanted.side);
    }
}

// Exposure stays, so that the lights are seen to change.
void ViewSession::setLights(const std::vector<double>& lights)
{
    lights_ = lights;
    std::vector<glm::vec3> factors;
    for (const double light : lights_) {
        factors.emplace_back(static_cast<float>(light));
    }
    const std::optional<double> rmse = films_.setLights(factors);
    lightsError_ = rmse ? formatted("with these lights: RMSE %.3g %% of the mean", 100.0 * *rmse) : "";
    exposureIsAuto_ = false;
    chooseLayer(layer_);
}

std::vector<Side> ViewSession::sides() const
{
    const ViewedLayer& layer = films_.layers()[layer_];
    std::vector<Side> has;
    if (layer.of[0]) {
        has.push_back(Side::A);
    }
    if (layer.of[1]) {
        has.push_back(Side::B);
    }
    if (has.size() == 2 && shown_.layer.shownAs != ShownAs::Ids) {
        has.push_back(Side::Difference);
    }
    return has;
}

void ViewSession::tell(const std::string& text)
{
    say(MessageId::WindowReport, {text});
    notice_.show(text);
    changed_ = true;
}

void ViewSession::readChangedFilms()
{
    const glm::uvec2 before = films_.size();
    const std::string name = films_.layers()[layer_].name;
    const ViewedFilms::Reading reading = films_.readChanged();
    if (!reading.taken.empty()) {
        const auto& layers = films_.layers();
        const auto same = std::find_if(layers.begin(), layers.end(), [&](const ViewedLayer& layer) { return layer.name == name; });
        lights_.assign(films_.lightGroups().size(), 1.0);
        lightsError_.clear();
        chooseLayer(same == layers.end() ? 0 : static_cast<std::size_t>(same - layers.begin()));
        if (films_.size() != before) {
            place(fit(films_.size(), painter_.size()));
            isFitted_ = true;
        }
    }
    for (const std::string& file : reading.taken) {
        tell(file + ": read again");
    }
    if (reading.trouble) {
        tell(reading.trouble->sentence);
    }
}

void ViewSession::draw()
{
    const bool differs = side_ == Side::Difference;
    const ShownAs as = shown_.layer.shownAs;
    const std::size_t side = side_ == Side::B ? 1 : 0;
    const bool isTransparent = !differs && !alphas_[side].radiance.empty();
    if (!laid_) {
        const bool averages = as != ShownAs::Ids && as != ShownAs::Depth;  // means of ids, or of a depth and nothing, mean nothing
        for (const std::size_t i : {std::size_t{0}, std::size_t{1}}) {
            if (differs || side_ == (i == 0 ? Side::A : Side::B)) {
                layUnder({films_.size(), values_[i].radiance}, viewport_, painter_.size(), averages, under_[i]);
            }
        }
        painter_.setValues(under_[side]);
        if (isTransparent) {
            layUnder({films_.size(), alphas_[side].radiance}, viewport_, painter_.size(), averages, under_[1 - side]);
        }
        if (differs || isTransparent) {
            painter_.setReference(under_[isTransparent ? 1 - side : 1]);
        }
        laid_ = true;
    }
    const Rectangle covered = coveredBy(viewport_, films_.size(), painter_.size());
    ViewPass pass{};
    pass.left = covered.low.x;
    pass.top = covered.low.y;
    pass.right = covered.high.x;
    pass.bottom = covered.high.y;
    pass.shownAs = isTransparent ? kShownAsSurfaces
                                 : static_cast<std::uint32_t>(differs              ? ShownAs::Difference
                                                              : as == ShownAs::Ids ? ShownAs::Color
                                                                                   : as);
    pass.scale = isExposed() ? static_cast<float>(std::exp2(exposure())) : 1.0F;
    pass.tone = static_cast<std::uint32_t>(isToned() ? tone_ : Tone::None);
    pass.low = shown_.range.low;
    pass.high = shown_.range.high;
    if (differs) {
        pass.scale /= static_cast<float>(shown_.difference->scale > 0.0 ? shown_.difference->scale : 1.0);
        pass.relative = static_cast<float>(shown_.difference->relative);
        pass.epsilon = static_cast<float>(shown_.difference->epsilon);
    }
    painter_.draw(pass);
    drawn_ = true;
}

void ViewSession::present()
{
    buildPanels();
    buildPanels();  // ImGui lays out a frame by the sizes of the one before
    if (!drawn_) {
        draw();
    }
    if (!screen_.present(painter_.picture())) {
        return;
    }
    changed_ = false;
    const Clock::time_point now = Clock::now();
    for (const Clock::time_point came : std::exchange(waiting_, {})) {
        latency_.add(secondsBetween(came, now));
    }
    window_.reportShown(0, true, handledEvents_);
}

void ViewSession::buildPanels()
{
    const ViewChoices before = shownChoices();
    ViewChoices wanted = before;
    gui_.frame(painter_.size(), [&] {
        if (panelLevel_ == 0) {
            return;
        }
        const float below = showMessages(notice_.text().empty() ? std::vector<std::string>{} : std::vector{notice_.text()});
        if (panelLevel_ == 1) {
            wanted = showViewPanel(figures(), before);
        } else {
            showViewHelp(below);
        }
    });
    change(wanted);
}

ViewFigures ViewSession::figures() const
{
    ViewFigures figures;
    for (const ViewedLayer& layer : films_.layers()) {
        figures.layers.push_back(layer.name);
    }
    figures.sides = sides();
    figures.isExposed = isExposed();
    figures.isToned = isToned();
    figures.lights = films_.lightGroups();
    for (std::size_t i = 0; i < films_.count(); ++i) {
        figures.lines.push_back(std::string(i == 0 ? "A " : "B ") + films_.path(i).filename().string());
    }
    const auto low = static_cast<double>(shown_.range.low), high = static_cast<double>(shown_.range.high);
    figures.lines.push_back(formatted("%ux%u at %.4g %%", films_.size().x, films_.size().y, 100.0 * viewport_.zoom));
    if (side_ == Side::Difference) {
        const double full = shown_.difference->scale * std::exp2(-gain_);
        const char* unit = shown_.difference->relative > 0.0 ? ", relative" : "";
        figures.lines.push_back(formatted("blue %.3g, white 0, red %.3g%s", -full, full, unit));
        figures.lines.push_back(shown_.difference->error);
    } else if (shown_.layer.shownAs == ShownAs::Depth) {
        figures.lines.push_back(formatted("white %.4g, grey %.4g", low, high));
    } else if (shown_.layer.shownAs == ShownAs::Heat) {
        figures.lines.push_back(formatted("blue %.3g, red %.3g", low, high));
    }
    if (!lightsError_.empty()) {
        figures.lines.push_back(lightsError_);
    }
    for (std::string& line : describePixel()) {
        figures.lines.push_back(std::move(line));
    }
    return figures;
}

// The numbers of the layer under the mouse.
std::vector<std::string> ViewSession::describePixel() const
{
    const auto place = pointer_ ? pixelAt(viewport_, *pointer_, films_.size()) : std::nullopt;
    const std::size_t pixel = place ? std::size_t{place->y} * films_.size().x + place->x : 0;
    std::vector<std::string> lines{
        place ? formatted("pixel (%u, %u)", place->x + films_.image(0).columnsLeft, place->y + films_.image(0).rowsAbove) : "pixel -"};
    std::array<std::vector<double>, 2> numbers;
    const ViewedLayer& layer = films_.layers()[layer_];
    for (std::size_t i = 0; i < films_.count(); ++i) {
        if (place && layer.of[i]) {
            numbers[i] = numbersOf(films_.image(i), *layer.of[i], pixel);
        }
        lines.push_back((i == 0 ? "A " : "B ") + toText(numbers[i]));
    }
    if (films_.count() > 1) {
        std::vector<double> differences;
        for (std::size_t c = 0; c < std::min(numbers[0].size(), numbers[1].size()); ++c) {
            differences.push_back(numbers[0][c] - numbers[1][c]);
        }
        lines.push_back("A - B " + toText(differences));
    }
    return lines;
}

void ViewSession::printLights() const
{
    const std::vector<std::string> groups = films_.lightGroups();
    for (std::size_t g = 0; g < groups.size(); ++g) {
        std::cout << (g == 0 ? "" : " ") << "--light " << escaped(groups[g]) << '=' << exactText(std::round(1e4 * lights_[g]) / 1e4);
    }
    std::cout << (groups.empty() ? "" : "\n") << std::flush;
}

void ViewSession::print(const glm::uvec2& pixel) const
{
    const glm::uvec2 size = films_.size();
    std::cout << "pixel (" << pixel.x + films_.image(0).columnsLeft << ", " << pixel.y + films_.image(0).rowsAbove << ") of " << size.x
              << "x" << size.y << '\n';
    for (std::size_t i = 0; i < films_.count(); ++i) {
        std::cout << escaped(films_.path(i).string()) << ':';
        const char* separator = " ";
        for (const ViewedLayer& layer : films_.layers()) {
            if (layer.of[i]) {
                std::cout << separator << escaped(layer.name) << ' '
                          << toText(numbersOf(films_.image(i), *layer.of[i], std::size_t{pixel.y} * size.x + pixel.x));
                separator = ", ";
            }
        }
        std::cout << '\n';
    }
    std::cout << std::flush;
}

}  // namespace glim
