#include "host/window/window.hpp"

#include "host/error.hpp"

#include <GLFW/glfw3.h>

#include <algorithm>
#include <cctype>
#include <utility>

namespace glim {
namespace {

constexpr double kWaitSeconds = 0.25;
constexpr std::uint32_t kLargestSide = 65535;  // of a window, in pixels

static_assert(kLeftButton == GLFW_MOUSE_BUTTON_LEFT && kRightButton == GLFW_MOUSE_BUTTON_RIGHT &&
              kMiddleButton == GLFW_MOUSE_BUTTON_MIDDLE);

Window* self(GLFWwindow* window) { return static_cast<Window*>(glfwGetWindowUserPointer(window)); }

std::string reason()
{
    const char* text = nullptr;
    glfwGetError(&text);
    return text != nullptr ? text : "no reason given";
}

[[noreturn]] void refuse(const std::string& what)
{
    throw InputError(MessageId::NoWindow, {what, " (", reason(), "); `glim render --image` writes pictures without a window."});
}

// It may be called again.
void initialize()
{
    if (glfwInit() == GLFW_FALSE) {
        refuse("No window can be opened here");
    }
}

// The key's name as the help has it, or '\0'. Letters, + and - follow the user's keyboard layout; other keys, and also + and -, are
// found by their place on an American keyboard.
char getName(int key, int scancode)
{
    if (key == GLFW_KEY_ESCAPE) {
        return kEscape;
    }
    if (key == GLFW_KEY_F11) {
        return kFullScreen;
    }
    const char* name = glfwGetKeyName(key, scancode);
    if (name != nullptr && (name[0] == '+' || name[0] == '-') && name[1] == '\0') {
        return name[0];
    }
    if (key == GLFW_KEY_EQUAL || key == GLFW_KEY_KP_ADD) {
        return '+';
    }
    if (key == GLFW_KEY_MINUS || key == GLFW_KEY_KP_SUBTRACT) {
        return '-';
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
    initialize();
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    window_ = glfwCreateWindow(static_cast<int>(size.x), static_cast<int>(size.y), title.c_str(), nullptr, nullptr);
    if (window_ == nullptr) {
        const std::string why = reason();
        glfwTerminate();
        throw InputError(MessageId::NoWindow,
                         {"No window can be opened here (", why, "); `glim render --image` writes pictures without one."});
    }
    glfwSetWindowUserPointer(window_, this);
    glfwSetKeyCallback(window_,
                       [](GLFWwindow* w, int key, int scancode, int action, int) { self(w)->onKey(getName(key, scancode), action); });
    glfwSetMouseButtonCallback(window_, [](GLFWwindow* w, int button, int action, int modifiers) {
        self(w)->onButton(button, action, (modifiers & GLFW_MOD_SHIFT) != 0);
    });
    glfwSetCursorPosCallback(window_, [](GLFWwindow* w, double x, double y) { self(w)->onCursor({x, y}); });
    glfwSetScrollCallback(window_, [](GLFWwindow* w, double, double y) { self(w)->onScroll(y); });
    glfwSetFramebufferSizeCallback(window_, [](GLFWwindow* w, int, int) { self(w)->onResize(); });
    glfwSetWindowRefreshCallback(window_, [](GLFWwindow* w) { self(w)->onResize(); });
    glfwSetWindowContentScaleCallback(window_, [](GLFWwindow* w, float x, float y) { self(w)->onScale(std::max(x, y)); });
    glfwSetDropCallback(window_, [](GLFWwindow* w, int count, const char** files) {
        for (int i = 0; i < count; ++i) {
            self(w)->onDrop(files[i]);
        }
    });
    // A window without focus is not told when keys and buttons are released.
    glfwSetWindowFocusCallback(window_, [](GLFWwindow* w, int has) {
        if (has == GLFW_FALSE) {
            self(w)->push({.kind = Event::Kind::FocusLost});
        }
    });
    glfwSetWindowCloseCallback(window_, [](GLFWwindow* w) { self(w)->onClose(); });
    float x = 1.0F, y = 1.0F;
    glfwGetWindowContentScale(window_, &x, &y);
    onScale(std::max(x, y));
    onResize();
    if (pictureSize() != size) {  // it was made of as many coordinates of the screen
        resize(size);
    }
}

Window::~Window()
{
    glfwDestroyWindow(window_);
    glfwTerminate();
}

glm::uvec2 Window::screenSize()
{
    initialize();
    GLFWmonitor* screen = glfwGetPrimaryMonitor();
    if (screen == nullptr) {
        return glm::uvec2(kLargestSide);
    }
    int left = 0, top = 0, width = 0, height = 0;
    glfwGetMonitorWorkarea(screen, &left, &top, &width, &height);
    return {std::max(width, 1), std::max(height, 1)};
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
    if (key == kFullScreen) {
        if (action == GLFW_PRESS) {
            toggleFullScreen();
        }
    } else if (key != '\0' && action != GLFW_REPEAT) {
        push({.kind = action == GLFW_PRESS ? Event::Kind::KeyDown : Event::Kind::KeyUp, .key = key});
    }
}

void Window::toggleFullScreen()
{
    if (windowed_) {
        const glm::ivec4 place = *std::exchange(windowed_, std::nullopt);
        glfwSetWindowMonitor(window_, nullptr, place.x, place.y, place.z, place.w, GLFW_DONT_CARE);
    } else if (GLFWmonitor* const screen = glfwGetPrimaryMonitor()) {
        glm::ivec4& place = windowed_.emplace();
        glfwGetWindowPos(window_, &place.x, &place.y);
        glfwGetWindowSize(window_, &place.z, &place.w);
        const GLFWvidmode* const mode = glfwGetVideoMode(screen);
        glfwSetWindowMonitor(window_, screen, 0, 0, mode->width, mode->height, mode->refreshRate);
    }
}

void Window::onButton(int button, int action, bool shift)
{
    const auto kind = action == GLFW_PRESS ? Event::Kind::ButtonDown : Event::Kind::ButtonUp;
    push({.kind = kind, .position = cursor_, .button = button, .shift = shift});
}

PixelScale Window::pixelScale() const
{
    glm::ivec2 size(0);
    glfwGetWindowSize(window_, &size.x, &size.y);
    return PixelScale::of(size, pictureSize());
}

void Window::resize(const glm::uvec2& size)
{
    const glm::ivec2 onScreen = pixelScale().toScreen(size);
    glfwSetWindowSize(window_, onScreen.x, onScreen.y);
}

void Window::onCursor(const glm::dvec2& position)
{
    cursor_ = pixelScale().toPixels(position);
    push({.kind = Event::Kind::Move, .position = cursor_});
}

void Window::onScroll(double notches) { push({.kind = Event::Kind::Scroll, .position = cursor_, .notches = notches}); }

void Window::onResize()
{
    int width = 0, height = 0;
    glfwGetFramebufferSize(window_, &width, &height);
    pictureWidth_ = static_cast<std::uint32_t>(width);
    pictureHeight_ = static_cast<std::uint32_t>(height);
    push({.kind = Event::Kind::Resize});
}

void Window::onScale(float scale)
{
    contentScale_ = scale;
    push({.kind = Event::Kind::Resize});
}

void Window::onDrop(const std::filesystem::path& file) { push({.kind = Event::Kind::Drop, .file = file}); }

void Window::onClose()
{
    glfwHideWindow(window_);
    push({.kind = Event::Kind::Close});
}

void Window::carryOut(const Orders& orders)
{
    if (orders.title) {
        glfwSetWindowTitle(window_, orders.title->c_str());
    }
    if (orders.size) {
        resize(*orders.size);
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
        onButton(GLFW_MOUSE_BUTTON_LEFT, GLFW_PRESS, false);
        onButton(GLFW_MOUSE_BUTTON_LEFT, GLFW_RELEASE, false);
        break;
    case Kind::Resize: resize(step.size); break;
    case Kind::Scale: onScale(step.scale); break;
    case Kind::Drop: onDrop(step.file); break;
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
    onButton(button, GLFW_PRESS, false);
    for (int i = 1; i <= kMoves; ++i) {
        onCursor(pixelScale().toScreen(glm::mix(step.from, step.to, static_cast<double>(i) / kMoves)));
    }
    onButton(button, GLFW_RELEASE, false);
}

}  // namespace glim
