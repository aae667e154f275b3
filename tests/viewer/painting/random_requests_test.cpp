// The painter under requests by chance, cancelled by chance: pictures fit what was asked for, and nothing breaks. Under
// the sanitizers this is where mistakes of memory show.
#include "base/parallel.h"
#include "base/random.h"
#include "modes/mode.h"
#include "viewer/fixtures.h"
#include "viewer/painting/painter.h"
#include "viewer/state/view_state.h"

#include <gtest/gtest.h>

#include <thread>

namespace tyndall::test {
namespace {
struct Chance {
    uint32_t seed, draws = 0;

    double share() { return random_unit(draws++, 0, 0, seed); }
    int below(int count) { return std::min(static_cast<int>(share() * count), count - 1); }
    double between(double low, double high) { return low + share() * (high - low); }
    const std::string& of(const std::vector<std::string>& names) {
        return names[static_cast<size_t>(below(static_cast<int>(names.size())))];
    }
};

std::vector<std::string> mode_names() {
    std::vector<std::string> names;
    for (const Mode& mode : modes()) names.emplace_back(mode.name);
    return names;
}

// A row anywhere in its range, near the lower end as a rule.
Action any_setting(Chance& chance) {
    const std::vector<SettingRow>& rows = setting_rows();
    const SettingRow& row = rows[static_cast<size_t>(chance.below(static_cast<int>(rows.size())))];
    if (!row.choices.empty()) return {Verb::set, {row.name, chance.of(row.choices)}, {}, {}};
    const double low = std::max(row.low, -20.0), high = std::max(low, std::min(row.high, 20.0)),
                 share = std::pow(chance.share(), 3);
    const double value = low + (high - low) * share;
    return {Verb::set, {row.name, row.integer ? std::to_string(std::lround(value)) : std::to_string(value)}, {}, {}};
}

Action any_action(Chance& chance) {
    const auto turn = [&] { return chance.between(-30, 30); };
    switch (chance.below(13)) {
    case 0:
        return {Verb::mode, {chance.of(mode_names())}, {}, {}};
    case 1:
        return {Verb::beside, {chance.share() < 0.4 ? "" : chance.of(mode_names())}, {}, {}};
    case 2:
        return {Verb::quality, {chance.of({"draft", "preview"})}, {}, {}};
    case 3:
        return {Verb::show, {chance.of(shown_layer_names())}, {}, {}};
    case 4:
        return {Verb::exposure, {std::to_string(chance.between(-3, 3))}, {}, {}};
    case 5:
        return {Verb::wipe, {}, {chance.share()}, {}};
    case 6:
        return {Verb::size, {}, {1.0 + chance.below(70), 1.0 + chance.below(50)}, {}};
    case 7:
        return {Verb::frame, {}, {1.0 + chance.below(4)}, {}};
    case 8:
        return {Verb::orbit, {}, {turn(), turn()}, {}};
    case 9:
        return {Verb::reset, {"all"}, {}, {}};
    default:
        return any_setting(chance);
    }
}

// A picture, or none when work was cancelled before it was done.
std::optional<ShownPicture> paint_for_a_while(Painter& painter, const Request& request, int microseconds) {
    std::atomic<bool> cancel{false}, done{false};
    std::thread impatient([&] {
        const auto end = std::chrono::steady_clock::now() + std::chrono::microseconds(microseconds);
        while (!done && std::chrono::steady_clock::now() < end)
            std::this_thread::sleep_for(std::chrono::microseconds(100));
        cancel = true;
    });
    std::optional<ShownPicture> picture = paint(painter, request, cancel);
    done = true, impatient.join();
    return picture;
}

class RandomRequests : public testing::TestWithParam<uint32_t> {};

TEST_P(RandomRequests, EveryPictureFitsItsRequest) {
    flush_denormals();
    Chance chance{GetParam()};
    ViewState state;
    take_scene(state, small_scene());
    state.max_samples = 6;
    Painter painter;
    int pictures = 0, whole = 0;
    for (int i = 0; i < 150; ++i) {
        apply(state, any_action(chance));
        for (int rounds = chance.below(4); rounds >= 0; --rounds) {
            const Request request = request_of(state, chance.share() < 0.5);
            const auto picture = paint_for_a_while(painter, request, chance.below(6000));
            if (!picture || !picture->error.empty()) continue;
            ++pictures;
            EXPECT_EQ(picture->revision, request.revision);
            EXPECT_EQ(picture->wanted, request.size);
            EXPECT_NO_THROW(find_mode(picture->mode));
            EXPECT_EQ(picture->codes.pixels.size(),
                      static_cast<size_t>(picture->codes.size.x) * static_cast<size_t>(picture->codes.size.y));
            if (picture->quick) continue;
            EXPECT_EQ(picture->codes.size, request.size);
            ++whole;
        }
    }
    EXPECT_GT(pictures, 50);
    EXPECT_GT(whole, 5);
}
INSTANTIATE_TEST_SUITE_P(Seeds, RandomRequests, testing::Range(1u, 5u));
}
}
