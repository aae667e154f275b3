// The reports of tyndall info, one function per kind of file; text for people, or JSON.
#pragma once
#include <filesystem>
#include <string>

namespace tyndall {
std::string vdb_report(const std::filesystem::path& file, bool json);
std::string gltf_report(const std::filesystem::path& file, bool json);
std::string scene_report(const std::filesystem::path& file, bool json);
std::string recipe_report(const std::filesystem::path& file, bool json);
std::string ies_report(const std::filesystem::path& file, bool json);
std::string exr_report(const std::filesystem::path& file, bool json);
}
