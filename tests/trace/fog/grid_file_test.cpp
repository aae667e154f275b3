// Sequences of a simulation that has no grids before it emits, and lacks a named one in some of its files.
#include "trace/fog/grid_file.h"

#include "scene/scene.h"
#include "support/expect.h"
#include "support/load_answer.h"
#include "support/scratch.h"
#include "trace/snapshot.h"
#include "volume/medium.h"
#include "volume/vdb/vdb.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tyndall {
namespace {
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

// An OpenVDB file of version 224 with neither metadata nor grids.
std::string no_grids() {
    std::string bytes("\x20\x42\x44\x56\0\0\0\0\xe0\0\0\0\x0a\0\0\0\0\0\0\0\0", 21);
    return bytes.append(36 + 4 + 4, '\0');
}

void write_grids(const std::filesystem::path& file, const std::vector<std::string>& names) {
    VdbContent content;
    for (const std::string& name : names) content.grids.push_back({name});
    content.origins = {ivec3(0)};
    content.fill = [](size_t, std::span<Leaf> leaves) {
        for (Leaf& leaf : leaves) leaf.values.fill(1500);
    };
    VdbImage(content, {}, "test").write(file);
}

// Frames 1 to 4: nothing; fog; fog and temperature; fog.
class GridFile : public ::testing::Test {
protected:
    GridFile() {
        scratch.put("sim.0001.vdb", no_grids());
        write_grids(scratch / "sim.0002.vdb", {"density"});
        write_grids(scratch / "sim.0003.vdb", {"density", "temperature"});
        write_grids(scratch / "sim.0004.vdb", {"density"});
    }
    std::string file_at(const std::string& grid, int frame, MissingFrame missing) {
        notes.clear();
        const std::vector<std::string> grids(grid.empty() ? 0 : 1, grid);
        const auto file = grid_file(find_sequence("sim.####.vdb", scratch.path()), grids, frame, missing, notes);
        return file ? file->filename().string() : "";
    }

    TempFolder scratch;
    std::vector<std::string> notes;
};

TEST_F(GridFile, AFileWithoutGridsIsAnInstantWithoutFog) {
    for (const MissingFrame missing : {MissingFrame::error, MissingFrame::hold, MissingFrame::skip})
        for (const char* grid : {"", "density", "temperature"}) {
            EXPECT_EQ(file_at(grid, 1, missing), "");
            EXPECT_THAT(notes, ElementsAre("sim.0001.vdb: contains no grids: nothing is shown"));
        }
    EXPECT_EQ(file_at("", 2, MissingFrame::error), "sim.0002.vdb");
    EXPECT_THAT(notes, IsEmpty());
}

TEST_F(GridFile, AFileThatLacksAGridOfOthersCountsAsMissing) {
    EXPECT_EQ(file_at("temperature", 3, MissingFrame::error), "sim.0003.vdb");
    EXPECT_EQ(file_at("temperature", 4, MissingFrame::hold), "sim.0003.vdb");
    EXPECT_THAT(notes, ElementsAre("sim.0004.vdb: has no grid \"temperature\": sim.0003.vdb is shown instead"));
    EXPECT_EQ(file_at("temperature", 2, MissingFrame::hold), "") << "nothing earlier has one";
    EXPECT_THAT(notes, ElementsAre("sim.0002.vdb: has no grid \"temperature\": nothing is shown"));
    EXPECT_EQ(file_at("temperature", 4, MissingFrame::skip), "");
    EXPECT_THAT(
        error_message(ExitCode::refused, [&] { file_at("temperature", 4, MissingFrame::error); }),
        HasSubstr("sim.0004.vdb: has no grid \"temperature\", unlike other files of the sequence; --missing hold"));
    EXPECT_EQ(file_at("heat", 3, MissingFrame::skip), "sim.0003.vdb") << "no file has it: reading one says so";
}

TEST_F(GridFile, AScenesFogAppearsWithTheFirstGrids) {
    const auto scene = load(scratch.put("scene.json", R"({"tyndall": 1, "media": [{"type": "vdb",
        "file": "sim.####.vdb", "extinction": 1e-4, "grids": {"temperature": "temperature"},
        "blackbody": {"convention": "kelvin"}}]})"))
                           .scene;
    ASSERT_EQ(scene.media.size(), 1u);
    const auto count = [&](int frame) {
        const Snapshot snapshot = make_snapshot(scene, Moment{frame, 0}, nullptr, MissingFrame::skip);
        notes = snapshot.notes;
        return snapshot.media.size();
    };
    EXPECT_EQ(count(1), 0u);
    EXPECT_THAT(notes, ElementsAre("sim.0001.vdb: contains no grids: nothing is shown"));
    EXPECT_EQ(count(2), 1u);
    EXPECT_EQ(count(3), 2u);
    const std::string single = R"({"tyndall": 1, "media": [{"type": "vdb", "file": "sim.0001.vdb"}]})";
    const auto alone = load(scratch.put("single.json", single)).scene;
    EXPECT_THAT(error_message(ExitCode::refused,
                              [&] {
                                  make_snapshot(alone, Moment{1, 0});
                              }),
                HasSubstr("sim.0001.vdb: contains no grids"));
}
}
}
