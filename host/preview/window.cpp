#include "host/preview/window.hpp"

#include "host/error.hpp"

#include <GLFW/glfw3.h>

#include <algorithm>
#include <cctype>
#include <utility>

namespace glim {
namespace {

constexpr double kClickPixels = 3.0;  // a click becomes a drag if the mouse moves as far
constexpr double kWaitSeconds = 0.25;

Window* self(GLFWwindow* window) { return static_cast<Window*>(glfwGetWindowUserPointer(window)); }

std::string reason()
{
    const char* text = nullptr;
    glfwGetError(&text);
    return text != nullptr ? text : "no reason given";
}

[[noreturn]] void refuse(const std::string& what) { throw InputError(what + " (" + reason() + "); `glim render` needs no window."); }

// The key's name as the help has it, or '\0'. Letters, + and - follow the user's keyboard layout; other keys, and also + and -, are
// found by their place on an American keyboard.
char nameOf(int key, int scancode)
{
    if (key == GLFW_KEY_ESCAPE) {
        return kEscape;
    }
    if (key == GLFW_KEY_EQUAL || key == GLFW_KEY_KP_ADD) {
        return '+';
    }
    if (key == GLFW_KEY_MINUS || key == GLFW_KEY_KP_SUBTRACT) {
        return '-';
    }
    const char* name = glfwGetKeyName(key, scancode);
    if (name != nullptr && (name[0] == '+' || name[0] == '-') && name[1] == '\0') {
        return name[0];
    }
    if (name != nullptr && std::isalpha(static_cast<unsigned char>(name[0])) && name[1] == '\0') {
        return static_cast<char>(std::toupper(static_cast<unsigned char>(name[0])));
    }
    const bool printable = key == GLFW_KEY_SPACE || (key >= GLFW_KEY_0 && key <= GLFW_KEY_9) || (key >= GLFW_KEY_A && key <= GLFW_KEY_Z);
    return printable ? static_cast<char>(key) : '\0';
}

}  // namespace

Window::Window(const std::string& title, const glm::uvec2& size, EventQueue& events)
    : events_(events)
{
    if (glfwInit() == GLFW_FALSE) {
        refuse("No window can be opened here");
    }
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    window_ = glfwCreateWindow(static_cast<int>(size.x), static_cast<int>(size.y), title.c_str(), nullptr, nullptr);
    if (window_ == nullptr) {
        const std::string why = reason();
        glfwTerminate();
        throw InputError("No window can be opened here (" + why + "); `glim render` needs none.");
    }
    glfwSetWindowUserPointer(window_, this);
    glfwSetKeyCallback(window_,
                       [](GLFWwindow* w, int key, int scancode, int action, int) { self(w)->onKey(nameOf(key, scancode), action); });
    glfwSetMouseButtonCallback(window_, [](GLFWwindow* w, int button, int action, int modifiers) {
        const bool pans = button == GLFW_MOUSE_BUTTON_MIDDLE || (modifiers & GLFW_MOD_SHIFT) != 0;
        self(w)->onButton(pans, button, action);
    });
    glfwSetCursorPosCallback(window_, [](GLFWwindow* w, double x, double y) { self(w)->onCursor({x, y}); });
    glfwSetScrollCallback(window_, [](GLFWwindow* w, double, double y) { self(w)->onScroll(y); });
    glfwSetFramebufferSizeCallback(window_, [](GLFWwindow* w, int, int) { self(w)->onResize(); });
    glfwSetWindowContentScaleCallback(window_, [](GLFWwindow* w, float, float) { self(w)->onResize(); });
    glfwSetWindowFocusCallback(window_, [](GLFWwindow* w, int has) { self(w)->onFocus(has == GLFW_TRUE); });
    glfwSetWindowCloseCallback(window_, [](GLFWwindow* w) { self(w)->onClose(); });
    onResize();
}

Window::~Window()
{
    glfwDestroyWindow(window_);
    glfwTerminate();
}

std::vector<const char*> Window::instanceExtensions()
{
    std::uint32_t count = 0;
    const char** names = glfwGetRequiredInstanceExtensions(&count);
    if (names == nullptr) {
        refuse("Vulkan cannot show pictures in a window here");
    }
    return {names, names + count};
}

VkSurfaceKHR Window::createSurface(const VulkanInstance& instance) const
{
    VkSurfaceKHR surface = VK_NULL_HANDLE;
    if (glfwCreateWindowSurface(instance.handle(), window_, nullptr, &surface) != VK_SUCCESS) {
        refuse("Vulkan cannot show pictures in this window");
    }
    return surface;
}

void Window::setTitle(const std::string& title)
{
    const std::lock_guard lock(mutex_);
    orders_.title = title;
    glfwPostEmptyEvent();
}

void Window::setSize(const glm::uvec2& size)
{
    const std::lock_guard lock(mutex_);
    orders_.size = size;
    glfwPostEmptyEvent();
}

void Window::reportShown(std::uint64_t samples, bool ended, std::uint64_t events)
{
    samples_ = samples;
    ended_ = ended;
    handledEvents_ = events;
}

void Window::finish()
{
    finished_ = true;
    glfwPostEmptyEvent();
}

void Window::push(Event event)
{
    ++pushedEvents_;
    event.when = std::chrono::steady_clock::now();
    events_.push(event);
}

void Window::onKey(char key, int action)
{
    if (key == '\0' || action == GLFW_REPEAT) {
        return;
    }
    if (action == GLFW_PRESS) {
        heldKeys_.insert(key);
    } else {
        heldKeys_.erase(key);
    }
    push({action == GLFW_PRESS ? Event::Kind::KeyDown : Event::Kind::KeyUp, {}, key, {}, {}});
}

void Window::onButton(bool pans, int button, int action)
{
    if (action == GLFW_PRESS && button_ < 0 && button != GLFW_MOUSE_BUTTON_RIGHT) {
        button_ = button;
        pans_ = pans;
        dragged_ = false;
        pressedAt_ = cursor_;
    } else if (action == GLFW_RELEASE && button == button_) {
        if (!dragged_ && !pans_) {
            push({Event::Kind::Click, {}, '\0', {}, cursor_});
        }
        button_ = -1;
    }
}

void Window::onCursor(const glm::dvec2& position)
{
    int width = 0, height = 0;
    glfwGetWindowSize(window_, &width, &height);
    const glm::dvec2 perUnit = glm::dvec2(pictureSize()) / glm::max(glm::dvec2(1.0), glm::dvec2(width, height));
    const glm::dvec2 last = std::exchange(cursor_, position * perUnit);
    if (button_ < 0) {
        return;
    }
    if (dragged_) {
        push({pans_ ? Event::Kind::Pan : Event::Kind::Orbit, {}, '\0', cursor_ - last, {}});
    } else if (glm::length(cursor_ - pressedAt_) >= kClickPixels) {
        dragged_ = true;
        push({pans_ ? Event::Kind::Pan : Event::Kind::Orbit, {}, '\0', cursor_ - pressedAt_, {}});
    }
}

void Window::onScroll(double notches) { push({Event::Kind::Scroll, {}, '\0', {0.0, notches}, {}}); }

void Window::onResize()
{
    int width = 0, height = 0;
    glfwGetFramebufferSize(window_, &width, &height);
    pictureWidth_ = static_cast<std::uint32_t>(width);
    pictureHeight_ = static_cast<std::uint32_t>(height);
    float x = 1.0F, y = 1.0F;
    glfwGetWindowContentScale(window_, &x, &y);
    contentScale_ = std::max(x, y);
    push({Event::Kind::Resize, {}, '\0', {}, {}});
}

// A window without focus is not told when keys are released, so they count as released at once.
void Window::onFocus(bool has)
{
    if (!has) {
        for (const char key : std::exchange(heldKeys_, {})) {
            push({Event::Kind::KeyUp, {}, key, {}, {}});
        }
        button_ = -1;
    }
}

void Window::onClose()
{
    glfwHideWindow(window_);
    push({Event::Kind::Close, {}, '\0', {}, {}});
}

void Window::carryOut(const Orders& orders)
{
    if (orders.title) {
        glfwSetWindowTitle(window_, orders.title->c_str());
    }
    if (orders.size) {
        glfwSetWindowSize(window_, static_cast<int>(orders.size->x), static_cast<int>(orders.size->y));
    }
}

void Window::run(const std::vector<ScriptStep>& script)
{
    std::size_t next = 0;
    double last = glfwGetTime();
    while (!finished_) {
        const bool acts = next < script.size();
        const double wait = acts ? std::clamp(last + script[next].delay - glfwGetTime(), 0.001, kWaitSeconds) : kWaitSeconds;
        glfwWaitEventsTimeout(acts && script[next].kind == ScriptStep::Kind::Samples ? 0.005 : wait);
        Orders orders;
        {
            const std::lock_guard lock(mutex_);
            orders = std::exchange(orders_, {});
        }
        carryOut(orders);
        while (next < script.size() && isDue(script[next], glfwGetTime() - last)) {
            perform(script[next++]);
            last = glfwGetTime();
        }
    }
    glfwHideWindow(window_);
}

bool Window::isDue(const ScriptStep& step, double since) const
{
    const bool there = handledEvents_ == pushedEvents_ && (samples_ >= step.samples || ended_);
    return since >= step.delay && (step.kind != ScriptStep::Kind::Samples || there);
}

// Calls the functions that the same action of the user would call.
void Window::perform(const ScriptStep& step)
{
    using Kind = ScriptStep::Kind;
    switch (step.kind) {
    case Kind::Key:
    case Kind::Press: onKey(step.key, GLFW_PRESS); break;
    case Kind::Release: break;
    case Kind::Drag: drag(step); break;
    case Kind::Scroll: onScroll(step.notches); break;
    case Kind::Click:
        cursor_ = step.from;
        onButton(false, GLFW_MOUSE_BUTTON_LEFT, GLFW_PRESS);
        onButton(false, GLFW_MOUSE_BUTTON_LEFT, GLFW_RELEASE);
        break;
    case Kind::Resize: glfwSetWindowSize(window_, static_cast<int>(step.size.x), static_cast<int>(step.size.y)); break;
    case Kind::Iconify: glfwIconifyWindow(window_); break;
    case Kind::Restore: glfwRestoreWindow(window_); break;
    case Kind::Samples: break;
    case Kind::Close: onClose(); break;
    }
    if (step.kind == Kind::Key || step.kind == Kind::Release) {
        onKey(step.key, GLFW_RELEASE);
    }
}

void Window::drag(const ScriptStep& step)
{
    constexpr int kMoves = 4;
    const int button = step.pan ? GLFW_MOUSE_BUTTON_MIDDLE : GLFW_MOUSE_BUTTON_LEFT;
    cursor_ = step.from;
    onButton(step.pan, button, GLFW_PRESS);
    for (int i = 1; i <= kMoves; ++i) {
        int width = 0, height = 0;
        glfwGetWindowSize(window_, &width, &height);
        const glm::dvec2 unit = glm::dvec2(width, height) / glm::max(glm::dvec2(1.0), glm::dvec2(pictureSize()));
        onCursor(glm::mix(step.from, step.to, static_cast<double>(i) / kMoves) * unit);
    }
    onButton(step.pan, button, GLFW_RELEASE);
}

}  // namespace glim
