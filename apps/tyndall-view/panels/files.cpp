// The files panel: opens a scene; writes the image, a sequence or baked fog; shows the running job's progress.
#include "../theme.h"
#include "base/text.h"
#include "panels.h"
#include "scene/scene.h"
#include "viewer/painting/file_job.h"

#include <imgui_stdlib.h>

#include <algorithm>
#include <cmath>

namespace tyndall {
namespace {
constexpr const char* one_at_a_time = "One job at a time: wait for the one below to end";

// A file name field that follows what is shown until the user edits it.
void draw_name(const char* label, const std::string& usual, FileField& field) {
    if (!field.edited) field.name = usual;
    ImGui::SetNextItemWidth(-1);
    if (ImGui::InputText(label, &field.name)) field.edited = true;
}

void draw_range(const char* label, const Scene& scene, std::string& range) {
    const std::string all = formatted("frames %d-%d", scene.first_frame, scene.last_frame);
    ImGui::SetNextItemWidth(8 * ImGui::GetFontSize());
    ImGui::InputTextWithHint(label, all.c_str(), &range);
    tooltip("Frames: 1-48, 1-48x2 (every second), 1,5,9; empty: all of the scene's");
}

// A button that is disabled while a job runs.
bool job_button(const char* text, const ViewState& state, const std::string& help) {
    ImGui::BeginDisabled(state.job.has_value());
    const bool pressed = ImGui::Button(text);
    ImGui::EndDisabled();
    if (ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled))
        ImGui::SetTooltip("%s", state.job ? one_at_a_time : help.c_str());
    return pressed;
}

void draw_open(const ViewState& state, FilesState& memory, const Act& act) {
    if (!memory.other.edited) memory.other.name = state.scene_file.string();
    const ImGuiStyle& style = ImGui::GetStyle();
    ImGui::SetNextItemWidth(-ImGui::CalcTextSize("Open").x - 2 * style.FramePadding.x - style.ItemSpacing.x);
    const bool entered = ImGui::InputText("##other", &memory.other.name, ImGuiInputTextFlags_EnterReturnsTrue);
    if (ImGui::IsItemEdited()) memory.other.edited = true;
    ImGui::SameLine();
    const bool pressed = ImGui::Button("Open");
    tooltip("A scene (.json), a .gltf, .glb or .vdb; files can also be dropped on the window");
    if (!entered && !pressed) return;
    memory.other.edited = false;
    act({Verb::open, {memory.other.name}, {}, {}});
}

void draw_picture_file(const ViewState& state, FilesState& memory, const Act& act) {
    draw_name("##picture", default_file_name(state), memory.picture);
    if (ImGui::Button("Write image")) {
        act({Verb::snapshot, {memory.picture.name}, {}, {}});
        memory.picture.edited = false;
    }
    tooltip("The whole image with " + std::to_string(state.settings.pixel.samples) +
            " samples per pixel, as tyndall render writes it: .exr for linear light, .png for viewing");
}

std::vector<std::string> sequence_words(const FilesState& memory) {
    return {memory.sequence.name, memory.frames, memory.pngs ? "png" : "exr"};
}

void draw_command(const FilesState& memory, const Act& act) {
    const bool pressed = ImGui::Button("Copy command");
    tooltip("The command line that renders the same frames, for a shell or a farm");
    if (pressed) act({Verb::copy_command, sequence_words(memory), {}, {}});
}

void draw_sequence(const ViewState& state, FilesState& memory, const Act& act) {
    draw_name("##sequence", default_sequence_name(state), memory.sequence);
    draw_range("##frames", *state.scene, memory.frames);
    ImGui::SameLine();
    ImGui::Checkbox("PNGs too", &memory.pngs);
    if (job_button("Render sequence", state,
                   "All frames with " + std::to_string(state.settings.pixel.samples) +
                       " samples per pixel, as tyndall render does, in the background, with the view and the edits "
                       "of this moment. Frames that exist and are up to date are skipped"))
        act({Verb::render, sequence_words(memory), {}, {}});
    ImGui::SameLine();
    draw_command(memory, act);
}

void draw_bake(const ViewState& state, FilesState& memory, const Act& act) {
    const std::vector<std::string> media = bakeable_media(*state.scene);
    if (media.empty()) return;
    ImGui::Separator();
    if (std::ranges::find(media, memory.medium) == media.end()) memory.medium = media.front();
    if (media.size() > 1) {
        ImGui::SetNextItemWidth(-1);
        if (ImGui::BeginCombo("##baked", memory.medium.c_str())) {
            for (const std::string& name : media)
                if (ImGui::Selectable(name.c_str(), name == memory.medium))
                    memory.medium = name, memory.fog.edited = false;
            ImGui::EndCombo();
        }
    }
    draw_name("##fog", default_bake_name(memory.medium), memory.fog);
    draw_range("##fog frames", *state.scene, memory.fog_frames);
    ImGui::SameLine();
    if (job_button("Bake fog", state,
                   "\"" + memory.medium + "\" to VDB files, as tyndall bake makes them from its recipe"))
        act({Verb::bake, {memory.medium, memory.fog.name, memory.fog_frames}, {}, {}});
}
}

void draw_files(const ViewState& state, FilesState& memory, const Act& act) {
    if (!state.scene || !ImGui::CollapsingHeader("files", ImGuiTreeNodeFlags_DefaultOpen)) return;
    if (memory.scene != state.scene->file) memory = {state.scene->file, {}, {}, {}, {}, {}, {}, {}, memory.pngs};
    draw_open(state, memory, act);
    ImGui::Separator();
    draw_picture_file(state, memory, act);
    ImGui::Separator();
    draw_sequence(state, memory, act);
    draw_bake(state, memory, act);
}

void draw_job(const JobStatus& job, const Act& act) {
    std::string text = formatted("%s: %.0f of %s", job.name.c_str(), std::floor(job.share * job.frames + 1e-6),
                                 count_text(static_cast<uint64_t>(job.frames), "frame").c_str());
    if (job.stopping)
        text += ", stopping";
    else if (job.seconds_left >= 0)
        text += ", " + seconds_text(job.seconds_left) + " left";
    const float button = ImGui::CalcTextSize("Stop").x + 4 * ImGui::GetStyle().FramePadding.x;
    ImGui::ProgressBar(static_cast<float>(job.share),
                       {-button - ImGui::GetStyle().ItemSpacing.x, ImGui::GetFrameHeight()}, "");
    const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax(), pad = ImGui::GetStyle().FramePadding;
    ImGui::PushClipRect(low, high, true); // not as a label, which would end at ##
    ImGui::GetWindowDrawList()->AddText({low.x + 2 * pad.x, low.y + pad.y}, ImGui::GetColorU32(ImGuiCol_Text),
                                        text.c_str());
    ImGui::PopClipRect();
    tooltip(text);
    ImGui::SameLine();
    ImGui::BeginDisabled(job.stopping);
    if (ImGui::Button("Stop##job", {button, 0})) act({Verb::stop_job, {}, {}, {}});
    ImGui::EndDisabled();
    tooltip("Finished frames are kept; the job resumes after them when started again");
}
}
