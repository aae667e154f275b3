#include "window.h"

#include "base/error.h"
#include "theme.h"

#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <string_view>
#include <utility>

namespace tyndall {
namespace {
std::string& last_problem() {
    static std::string text;
    return text;
}

// Hash of all vertices, indices and clip rectangles.
size_t hash_of(const ImDrawData& data) {
    size_t sum = std::hash<float>()(data.DisplaySize.x) * 31 + std::hash<float>()(data.DisplaySize.y);
    const auto add = [&](const void* bytes, size_t count) {
        sum = sum * 1000003 + std::hash<std::string_view>()({static_cast<const char*>(bytes), count});
    };
    for (int i = 0; i < data.CmdListsCount; ++i) {
        const ImDrawList& list = *data.CmdLists[i];
        add(list.VtxBuffer.Data, static_cast<size_t>(list.VtxBuffer.size_in_bytes()));
        add(list.IdxBuffer.Data, static_cast<size_t>(list.IdxBuffer.size_in_bytes()));
        for (const ImDrawCmd& command : list.CmdBuffer) add(&command.ClipRect, sizeof command.ClipRect);
    }
    return sum;
}

// Gives ImGui this frame's mouse and keys from the queue, in place of the state that its backend polls.
void show_input(const InputQueue& input) {
    ImGuiIO& io = ImGui::GetIO();
    if (ImGui::IsMousePosValid(&io.MousePos)) io.MousePos = {input.mouse.x, input.mouse.y};
    for (int button = 0; button < ImGuiMouseButton_COUNT; ++button)
        io.MouseDown[button] = input.buttons.contains(button);
    std::ranges::fill(io.KeysDown, false);
    for (const int key : input.keys) io.KeysDown[key] = true;
    const auto either = [&](int left, int right) { return input.keys.contains(left) || input.keys.contains(right); };
    io.KeyCtrl = either(GLFW_KEY_LEFT_CONTROL, GLFW_KEY_RIGHT_CONTROL);
    io.KeyShift = either(GLFW_KEY_LEFT_SHIFT, GLFW_KEY_RIGHT_SHIFT);
    io.KeyAlt = either(GLFW_KEY_LEFT_ALT, GLFW_KEY_RIGHT_ALT);
}

InputQueue& queue(GLFWwindow* window) { return static_cast<Window*>(glfwGetWindowUserPointer(window))->input(); }

// Installs callbacks that put the user's input into the queue.
void note_input(GLFWwindow* window) {
    double x = 0, y = 0;
    glfwGetCursorPos(window, &x, &y);
    queue(window).mouse = vec2(x, y);
    glfwSetCursorPosCallback(window, [](GLFWwindow* one, double to_x, double to_y) {
        queue(one).add({InputEvent::Kind::move, vec2(to_x, to_y)});
    });
    glfwSetMouseButtonCallback(window, [](GLFWwindow* one, int button, int action, int) {
        queue(one).add({InputEvent::Kind::button, {}, button, action == GLFW_PRESS});
    });
    glfwSetKeyCallback(window, [](GLFWwindow* one, int key, int, int action, int) {
        if (key >= 0 && action != GLFW_REPEAT) queue(one).add({InputEvent::Kind::key, {}, key, action == GLFW_PRESS});
    });
}

[[noreturn]] void fail_display() {
    const std::string why = last_problem().empty() ? "a window cannot be opened" : printable(last_problem(), 120);
    fail(ExitCode::no_display, "no display",
         why + "; on a machine without one: xvfb-run -a tyndall view SCENE --script FILE");
}
}

const std::map<std::string, int>& key_codes() {
    static const std::map<std::string, int> codes = [] {
        std::map<std::string, int> all{{"space", GLFW_KEY_SPACE},    {"left", GLFW_KEY_LEFT},
                                       {"right", GLFW_KEY_RIGHT},    {"home", GLFW_KEY_HOME},
                                       {"tab", GLFW_KEY_TAB},        {"f1", GLFW_KEY_F1},
                                       {"f5", GLFW_KEY_F5},          {"escape", GLFW_KEY_ESCAPE},
                                       {"[", GLFW_KEY_LEFT_BRACKET}, {"]", GLFW_KEY_RIGHT_BRACKET}};
        for (char c = 'a'; c <= 'z'; ++c) all[std::string(1, c)] = GLFW_KEY_A + (c - 'a');
        for (char c = '0'; c <= '9'; ++c) all[std::string(1, c)] = GLFW_KEY_0 + (c - '0');
        return all;
    }();
    return codes;
}

std::string plain_key(std::string_view key) {
    for (const std::string_view modifier : {"ctrl+", "shift+"})
        if (key.starts_with(modifier)) key.remove_prefix(modifier.size());
    return std::string(key);
}

Window::Window(const std::string& title, ivec2 size) {
    glfwSetErrorCallback([](int, const char* text) { last_problem() = text; });
    if (!glfwInit()) fail_display();
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 0);
    window_ = glfwCreateWindow(size.x, size.y, title.c_str(), nullptr, nullptr);
    if (!window_) {
        glfwTerminate();
        fail_display();
    }
    glfwSetWindowUserPointer(window_, this);
    glfwSetWindowRefreshCallback(
        window_, [](GLFWwindow* window) { static_cast<Window*>(glfwGetWindowUserPointer(window))->stale_ = true; });
    glfwSetDropCallback(window_, [](GLFWwindow* window, int count, const char** files) {
        if (count > 0) static_cast<Window*>(glfwGetWindowUserPointer(window))->dropped_ = files[0];
    });
    note_input(window_); // before ImGui's backend, which chains to existing callbacks
    glfwMakeContextCurrent(window_);
    glfwSwapInterval(1);

    IMGUI_CHECKVERSION();
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr;
    float scale = 1, ignored = 1;
    glfwGetWindowContentScale(window_, &scale, &ignored);
    apply_theme(scale);
    // The panels need this much space, as far as the screen has it.
    GLFWmonitor* const monitor = glfwGetPrimaryMonitor();
    const GLFWvidmode* screen = monitor ? glfwGetVideoMode(monitor) : nullptr;
    const ivec2 least = glm::min(ivec2(scale * vec2(680, 480)), screen ? ivec2(screen->width, screen->height) : size);
    glfwSetWindowSizeLimits(window_, least.x, least.y, GLFW_DONT_CARE, GLFW_DONT_CARE);
    ImGui_ImplGlfw_InitForOpenGL(window_, true);
    ImGui_ImplOpenGL3_Init("#version 130");

    glGenTextures(2, textures_);
    for (const unsigned texture : textures_) {
        glBindTexture(GL_TEXTURE_2D, texture);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    }
}

Window::~Window() {
    glDeleteTextures(2, textures_);
    ImGui_ImplOpenGL3_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
    glfwDestroyWindow(window_);
    glfwTerminate();
}

bool Window::take_close() {
    const bool asked = glfwWindowShouldClose(window_);
    glfwSetWindowShouldClose(window_, GLFW_FALSE);
    return asked;
}

void Window::hide() { glfwHideWindow(window_); }

std::string Window::take_dropped() { return std::exchange(dropped_, {}); }

void Window::wait(double seconds) {
    if (seconds > 0 && input_.waiting.empty())
        glfwWaitEventsTimeout(seconds);
    else
        glfwPollEvents();
}

void Window::wake() { glfwPostEmptyEvent(); }

void Window::begin_frame(const ScriptedInput& input) {
    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    input_.next_frame();
    show_input(input_);
    if (input.active) {
        ImGuiIO& io = ImGui::GetIO();
        io.MousePos = {input.mouse.x, input.mouse.y};
        io.MouseDown[0] = input.down;
        const std::string key = plain_key(input.key);
        for (const auto& [name, code] : key_codes()) io.KeysDown[code] = name == key;
        io.KeyCtrl = input.key.starts_with("ctrl+"), io.KeyShift = input.key.find("shift+") != input.key.npos;
    }
    ImGui::NewFrame();
}

void Window::end_frame() { ImGui::Render(); }

bool Window::draw(bool anyway) {
    const size_t wanted = hash_of(*ImGui::GetDrawData());
    if (wanted == drawn_ && !stale_ && !anyway) return false;
    drawn_ = wanted, stale_ = false;
    int width = 0, height = 0;
    glfwGetFramebufferSize(window_, &width, &height);
    glViewport(0, 0, width, height);
    glClearColor(0.06f, 0.06f, 0.065f, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
    glFinish();
    return true;
}

void Window::swap() { glfwSwapBuffers(window_); }

void Window::set_title(const std::string& title) { glfwSetWindowTitle(window_, title.c_str()); }

void Window::set_texture(const Image<glm::u8vec4>& codes, size_t which) {
    glBindTexture(GL_TEXTURE_2D, textures_[which]);
    const ivec2 size = codes.size;
    if (size == texture_sizes_[which])
        glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, size.x, size.y, GL_RGBA, GL_UNSIGNED_BYTE, codes.pixels.data());
    else
        glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, size.x, size.y, 0, GL_RGBA, GL_UNSIGNED_BYTE, codes.pixels.data());
    texture_sizes_[which] = size, stale_ = true;
}

void Window::show_pixels(bool each) {
    glBindTexture(GL_TEXTURE_2D, textures_[0]);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, each ? GL_NEAREST : GL_LINEAR);
}

void* Window::picture(size_t which) const { return reinterpret_cast<void*>(static_cast<intptr_t>(textures_[which])); }

Image<glm::u8vec3> Window::pixels() const {
    ivec2 size{0};
    glfwGetFramebufferSize(window_, &size.x, &size.y);
    Image<glm::u8vec3> upside_down(size), image(size);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, size.x, size.y, GL_RGB, GL_UNSIGNED_BYTE, upside_down.pixels.data());
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) image.at(x, y) = upside_down.at(x, size.y - 1 - y);
    return image;
}
}
