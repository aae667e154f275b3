// What frames of the interface see of quick hands.
#include "viewer/state/input_queue.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
using enum InputEvent::Kind;

InputEvent moved(float x) { return {move, {x, 0}}; }
InputEvent pressed(int code) { return {button, {}, code, true}; }
InputEvent released(int code) { return {button, {}, code, false}; }
InputEvent key_down(int code) { return {key, {}, code, true}; }
InputEvent key_up(int code) { return {key, {}, code, false}; }
}

TEST(InputQueue, ADragCountsFromWhereItWasPressed) {
    InputQueue queue;
    for (const InputEvent& event : {moved(10), moved(30), pressed(0), moved(40), released(0), moved(90)})
        queue.add(event);
    queue.next_frame();
    EXPECT_EQ(queue.mouse.x, 30);
    EXPECT_TRUE(queue.buttons.empty());
    queue.next_frame();
    EXPECT_EQ(queue.mouse.x, 30) << "the frame of the press sees no motion";
    EXPECT_TRUE(queue.buttons.contains(0));
    queue.next_frame();
    EXPECT_EQ(queue.mouse.x, 40);
    EXPECT_TRUE(queue.buttons.contains(0));
    queue.next_frame();
    EXPECT_EQ(queue.mouse.x, 40);
    EXPECT_TRUE(queue.buttons.empty());
    queue.next_frame();
    EXPECT_EQ(queue.mouse.x, 90);
    EXPECT_TRUE(queue.waiting.empty());
}

TEST(InputQueue, TapsWithinOneFrameAreAllSeen) {
    InputQueue queue;
    for (int i = 0; i < 3; ++i) queue.add(key_down(65)), queue.add(key_up(65));
    int taps = 0;
    bool down = false;
    for (int frame = 0; frame < 8; ++frame) {
        queue.next_frame();
        taps += !down && queue.keys.contains(65);
        down = queue.keys.contains(65);
    }
    EXPECT_EQ(taps, 3);
    EXPECT_FALSE(down);
}

TEST(InputQueue, KeysPressedTogetherAreSeenTogether) {
    InputQueue queue;
    for (const int code : {341, 90}) queue.add(key_down(code));
    queue.next_frame();
    EXPECT_EQ(queue.keys, (std::set{90, 341}));
    queue.add(key_up(90)), queue.add(key_up(341));
    queue.next_frame();
    EXPECT_TRUE(queue.keys.empty());
}
}
