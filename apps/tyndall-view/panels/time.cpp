// The timeline.
#include "../theme.h"
#include "base/text.h"
#include "panels.h"
#include "scene/scene.h"
#include "trace/moment.h"
#include "viewer/state/view_state.h"

#include <algorithm>

namespace tyndall {
namespace {
// Marks frames on the timeline for which volume files are missing.
void mark_gaps(const ViewState& state) {
    const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
    const int first = state.scene->first_frame, count = state.scene->last_frame - first + 1;
    const float width = (high.x - low.x) / static_cast<float>(std::max(count, 1));
    for (const int frame : state.gaps) {
        const float x = low.x + width * static_cast<float>(frame - first);
        ImGui::GetWindowDrawList()->AddRectFilled({x, high.y - 4}, {x + std::max(width - 1, 1.0f), high.y},
                                                  ImGui::GetColorU32(trouble));
    }
    if (!state.gaps.empty()) tooltip(formatted("%zu frames lack a volume file (red)", state.gaps.size()));
}

// Chooses what to show for missing frames.
void draw_gaps(const ViewState& state, const Act& act) {
    if (state.gaps.empty()) return;
    struct Way {
        MissingFrame missing;
        const char *word, *doc;
    };
    constexpr Way ways[] = {{MissingFrame::error, "error", "missing frames: error"},
                            {MissingFrame::hold, "hold", "missing frames: hold the previous one"},
                            {MissingFrame::skip, "skip", "missing frames: skip the fog"}};
    ImGui::SetNextItemWidth(5.5f * ImGui::GetFontSize());
    const Way& now = *std::ranges::find(ways, state.missing, &Way::missing);
    const bool open = ImGui::BeginCombo("##gaps", now.word);
    if (!open) tooltip(now.doc);
    if (open) {
        for (const Way& way : ways)
            if (ImGui::Selectable(way.doc, &way == &now)) act({Verb::missing, {way.word}, {}, {}});
        ImGui::EndCombo();
    }
    ImGui::SameLine();
}
}

void draw_time(const ViewState& state, const Act& act) {
    if (!state.scene) return;
    const Scene& scene = *state.scene;
    const auto button = [&](const char* text, const char* help, const Action& action) {
        if (ImGui::Button(text)) act(action);
        tooltip(help);
        ImGui::SameLine();
    };
    button("|<", "first frame", {Verb::frame, {}, {static_cast<double>(scene.first_frame)}, {}});
    button("<", "one frame back (left)", {Verb::step, {}, {-1}, {}});
    if (state.playing)
        button("Stop", "space", {Verb::stop, {}, {}, {}});
    else
        button("Play", "space", {Verb::play, {}, {}, {}});
    button(">", "one frame on (right)", {Verb::step, {}, {1}, {}});
    bool loop = state.loop;
    if (ImGui::Checkbox("loop", &loop)) act({Verb::loop, {loop ? "on" : "off"}, {}, {}});
    ImGui::SameLine();

    draw_gaps(state, act);
    const std::string moment = formatted("%.2f s", moment_of(scene, state.frame).seconds);
    int frame = state.frame;
    ImGui::SetNextItemWidth(-ImGui::CalcTextSize("0000.00 s").x - ImGui::GetStyle().ItemSpacing.x);
    if (ImGui::SliderInt("##frame", &frame, scene.first_frame, std::max(scene.last_frame, scene.first_frame),
                         "frame %d"))
        act({Verb::frame, {}, {static_cast<double>(frame)}, {}});
    mark_gaps(state);
    ImGui::SameLine();
    ImGui::AlignTextToFramePadding();
    ImGui::TextDisabled("%s", moment.c_str());
}
}
