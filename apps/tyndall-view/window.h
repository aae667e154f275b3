// A window with Dear ImGui in it, and textures for images.
#pragma once
#include "base/image.h"
#include "viewer/state/input_queue.h"

#include <map>
#include <string>

struct GLFWwindow;

namespace tyndall {
// Mouse and keys set by a script, in place of the real ones.
struct ScriptedInput {
    bool active = false;
    vec2 mouse{-1e6f}; // in the window, pixels
    bool down = false;
    std::string key; // pressed in this frame, after "ctrl+" and "shift+"; empty = none
};

class Window {
public:
    // Throws Error (no_display).
    Window(const std::string& title, ivec2 size);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    bool take_close();          // true once after the user asks to close the window
    std::string take_dropped(); // a file dropped on the window, returned once; empty = none
    // Sleeps until an event arrives, at most `seconds`; returns at once while queued input is left for the next frame.
    void wait(double seconds);
    void hide();
    static void wake(); // from any thread: ends wait()
    void begin_frame(const ScriptedInput& input);
    void end_frame(); // completes the frame's draw lists; draws nothing yet
    // Draws the frame with GL. Returns false, without drawing, when the screen already shows it, unless `anyway`.
    bool draw(bool anyway);
    void swap();
    InputQueue& input() { return input_; }
    void set_title(const std::string& title);

    // Uploads texture 0 (the image) or 1 (the volume inspector's). Call between end_frame() and draw().
    void set_texture(const Image<glm::u8vec4>& codes, size_t which = 0);
    void show_pixels(bool each);           // magnifies the image's pixels as squares, or interpolates
    void* picture(size_t which = 0) const; // texture for ImGui::Image
    Image<glm::u8vec3> pixels() const;     // reads back what was drawn

private:
    GLFWwindow* window_ = nullptr;
    unsigned textures_[2]{};
    InputQueue input_;
    std::string dropped_;
    size_t drawn_ = 0;  // hash of what was drawn last
    bool stale_ = true; // a texture changed, or the window was uncovered
    ivec2 texture_sizes_[2]{};
};

// GLFW's key codes by the key names used in actions.
const std::map<std::string, int>& key_codes();

std::string plain_key(std::string_view key); // "z" of "ctrl+shift+z"
}
