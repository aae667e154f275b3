// A window with Dear ImGui in it, and textures for pictures.
#pragma once
#include "base/image.h"
#include "viewer/state/input_queue.h"

#include <map>
#include <string>

struct GLFWwindow;

namespace tyndall {
// Mouse and keys as a script holds them, instead of the real ones.
struct ScriptedInput {
    bool active = false;
    vec2 mouse{-1e6f}; // of the window, pixels
    bool down = false;
    std::string key; // pressed in this frame, "ctrl+" and "shift+" before it; empty = none
};

class Window {
public:
    // Throws Error (no_display).
    Window(const std::string& title, ivec2 size);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    bool take_close();          // its closing was asked for, said once
    std::string take_dropped(); // a file dropped on it, said once; empty = none
    // Sleeps until there is something to do, or for so long; not while hands have done more than a frame has seen.
    void wait(double seconds);
    void hide();
    static void wake(); // from any thread: ends wait()
    void begin_frame(const ScriptedInput& input);
    void end_frame(); // the frame's drawing is complete, but not on the screen
    // By GL; does nothing and says so when all of it is on the screen already, unless it is to be drawn anyway.
    bool draw(bool anyway);
    void swap();
    InputQueue& input() { return input_; }
    void set_title(const std::string& title);

    // There are two: the picture itself and another one. Call between end_frame() and draw().
    void set_picture(const Image<glm::u8vec4>& codes, size_t which = 0);
    void show_pixels(bool each);           // of the picture, enlarged, as squares; else smoothly
    void* picture(size_t which = 0) const; // texture for ImGui::Image
    Image<glm::u8vec3> pixels() const;     // of what was drawn

private:
    GLFWwindow* window_ = nullptr;
    unsigned textures_[2]{};
    InputQueue input_;
    std::string dropped_;
    size_t drawn_ = 0;  // hash of what was drawn last
    bool stale_ = true; // the picture is another one, or the window was uncovered
    ivec2 texture_sizes_[2]{};
};

// Names of keys as actions know them, with GLFW's numbers.
const std::map<std::string, int>& key_codes();

std::string plain_key(std::string_view key); // "z" of "ctrl+shift+z"
}
