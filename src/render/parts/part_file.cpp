#include "render/parts/part_file.h"

#include "base/error.h"
#include "base/io/file_hashes.h"
#include "base/json/json_values.h"
#include "base/text.h"
#include "render/sequence/job.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <span>

namespace tyndall {
namespace {
constexpr const char* fixed_names[fixed_sums] = {"surface.R",    "surface.G",    "surface.B",   "background.R",
                                                 "background.G", "background.B", "inscatter.R", "inscatter.G",
                                                 "inscatter.B",  "weight",       "alpha",       "transmittance",
                                                 "validity",     "kept",         "taken"};

std::string channel_name(const SumNode& node, size_t number) {
    const std::string prefix = formatted("s%d_%d_%d.", node.section, node.level, node.index);
    if (number < fixed_sums) return prefix + fixed_names[number];
    const size_t light = (number - fixed_sums) / 3;
    return prefix + formatted("light%zu.%c", light, "RGB"[(number - fixed_sums) % 3]);
}

std::string range_text(const PartRange& range) {
    return formatted("%lld %lld %d", static_cast<long long>(range.first), static_cast<long long>(range.last),
                     range.slices);
}

std::string label(const Grouping& grouping) { return formatted("%d/%d", grouping.part, grouping.parts); }

// Adds the header attributes that a part has and its image does not.
void add_attributes(const FramePart& part, const Grouping& grouping, const std::filesystem::path& file,
                    std::map<std::string, std::string>& attributes) {
    attributes["tyndall:part"] = label(grouping);
    attributes["tyndall:partRange"] = range_text(part.range);
    attributes["tyndall:partLeaves"] = std::to_string(part.leaves);
    attributes["tyndall:partCovered"] = part.covered ? "1" : "0";
    if (part.colored) attributes["tyndall:partColored"] = "1";
    attributes["tyndall:planFile"] =
        normal_path(grouping.plan_file).lexically_relative(normal_path(file).parent_path()).string();
    const std::vector<std::string>& names = part.lights.names;
    attributes["tyndall:partLights"] =
        format_json(json_object({{"names", json_list(names, [](const std::string& name) { return Json(name); })},
                                 {"of_light", part.lights.of_light}}));
}

struct Header {
    const std::map<std::string, std::string>& attributes;
    std::string file;

    const std::string& text(const char* name) const {
        const auto found = attributes.find(name);
        if (found == attributes.end())
            refuse(file, "is not a part of a planned frame: its header lacks " + std::string(name));
        return found->second;
    }
};

void read_range(const Header& header, FramePart& part) {
    long long first = 0, last = 0;
    const std::string &range = header.text("tyndall:partRange"), &leaves = header.text("tyndall:partLeaves");
    constexpr long long most = 1 << 30;
    if (std::sscanf(range.c_str(), "%lld %lld %d", &first, &last, &part.range.slices) != 3 || first < 0 ||
        last <= first || last > most || part.range.slices < 1)
        refuse(header.file, "tyndall:partRange: expected three numbers; got '" + printable(range, 40) + "'");
    part.range.first = first, part.range.last = last;
    part.leaves = parsed<int>(leaves).value_or(0);
    if (part.leaves < 1 || part.leaves > 64 || (part.leaves & (part.leaves - 1)) != 0)
        refuse(header.file, "tyndall:partLeaves: expected a power of two; got '" + printable(leaves, 40) + "'");
}

void read_lights(const Header& header, FramePart& part) {
    const Json json = parse_json(header.text("tyndall:partLights"), header.file);
    const Json *names = json.find("names"), *of_light = json.find("of_light");
    if (!names || !of_light || names->kind != Json::Kind::array || of_light->kind != Json::Kind::array)
        refuse(header.file, "tyndall:partLights: expected lists of names and of_light");
    for (const Json& name : names->items) part.lights.names.push_back(name.string);
    for (const Json& light : of_light->items) {
        if (light.number < 0 || light.number >= static_cast<double>(names->items.size()))
            refuse(header.file, "tyndall:partLights: no such layer");
        part.lights.of_light.push_back(static_cast<int>(light.number));
    }
}

const Image<float>& channel_of(const ExrFile& exr, const std::string& name, const std::string& file) {
    const Image<float>* channel = exr.channel(name);
    if (!channel) refuse(file, "damaged: it lacks channel " + name);
    return *channel;
}

// Throws Error (refused) unless sample counts are whole, no more are kept than taken, the number taken is possible for
// the node (a slice may have none) and no sum is NaN.
void check_sums(std::span<const float> sums, const SumNode& node, const FramePart& part, const SectionSamples& section,
                const std::string& file) {
    const bool every_pixel = part.range.slices == 1 && part.finished.empty();
    const int64_t size = int64_t{1} << node.level, leaves = part.leaves;
    const auto fewest = static_cast<float>(every_pixel ? section.fewest * size / leaves : 0);
    const auto most = static_cast<float>((section.most * size + leaves - 1) / leaves);
    for (size_t at = 0; at < sums.size(); at += part.stride) {
        const float kept = sums[at + kept_sum], taken = sums[at + taken_sum];
        const bool whole = std::floor(kept) == kept && std::floor(taken) == taken;
        if (!(whole && kept >= 0 && kept <= taken && taken >= fewest && taken <= most))
            refuse(file, "damaged: it has impossible sample counts");
    }
    if (std::ranges::any_of(sums, [](float sum) { return std::isnan(sum); })) refuse(file, "damaged: it has NaN sums");
}

// Finds the nodes and the number of values per pixel and node.
void find_sums(const ExrFile& exr, const std::string& file, FramePart& part) {
    const int64_t leaves = (part.range.last - part.range.first) / part.range.slices;
    if (leaves / part.leaves > static_cast<int64_t>(exr.channels.size()))
        refuse(file, "damaged: it has fewer channels than tyndall:partRange requires");
    part.nodes = nodes_of(part.range, part.leaves);
    part.stride = fixed_sums;
    while (exr.channel(channel_name(part.nodes[0], part.stride))) part.stride += 3;
}

// Reads the sums of the rows in `exr`.
void read_sums(const ExrFile& exr, const std::string& file, const SectionSamples& section, FramePart& part) {
    part.depth = channel_of(exr, "Z", file), part.off_center = channel_of(exr, "offset", file);
    part.size = part.depth.size;
    for (const SumNode& node : part.nodes) {
        std::vector<float>& sums = part.sums.emplace_back(part.depth.pixels.size() * part.stride);
        for (size_t k = 0; k < part.stride; ++k) {
            const Image<float>& values = channel_of(exr, channel_name(node, k), file);
            for (size_t i = 0; i < values.pixels.size(); ++i) sums[i * part.stride + k] = values.pixels[i];
        }
        check_sums(sums, node, part, section, file);
    }
}
}

PartRange range_of(const Grouping& grouping, const Mode& mode, const View& view) {
    const int groups = grouping.more > 0 ? grouping.more : grouping.groups;
    return part_range(grouping.part, grouping.parts, grouping.after * grouping.sections, groups * grouping.sections,
                      grouping.leaves, count_blocks(mode, view));
}

std::string part_name(const std::string& frame_file, const Grouping& grouping) {
    const int digits = static_cast<int>(std::to_string(grouping.parts).size());
    std::string word = formatted("part-%0*d-of-%d", digits, grouping.part, grouping.parts);
    if (grouping.more > 0)
        word = formatted("groups-%d-to-%d.", grouping.after + 1, grouping.after + grouping.more) + word;
    return std::filesystem::path(frame_file).replace_extension(word + ".exr").string();
}

void write_part(const std::filesystem::path& file, const FramePart& part, Provenance provenance,
                const Grouping& grouping) {
    add_attributes(part, grouping, file, provenance.attributes);
    std::vector<ExrChannel> channels;
    for (size_t n = 0; n < part.nodes.size(); ++n)
        for (size_t k = 0; k < part.stride; ++k)
            channels.push_back({channel_name(part.nodes[n], k), part.sums[n].data() + k, part.stride, true});
    channels.push_back({"Z", part.depth.pixels.data(), 1, true});
    channels.push_back({"offset", part.off_center.pixels.data(), 1, true});
    const bool finished = part.finished.empty();
    if (!finished) channels.push_back({"finished", part.finished.pixels.data(), 1, true});
    // Sums of samples are noisy: ZIP halves the size of run-length encoding but takes ten times as long.
    const ExrPacking packing = finished ? ExrPacking::run_lengths : ExrPacking::none;
    write_exr_channels(file, {part.display, part.low, part.size}, channels, provenance, packing);
}

namespace {
PartFile part_in(const ExrFile& exr, const std::filesystem::path& file) {
    const Header header{exr.attributes, file.string()};
    PartFile result{file,
                    (file.parent_path() / header.text("tyndall:planFile")).lexically_normal(),
                    {},
                    header.text("tyndall:hash"),
                    header.text("tyndall:planHash"),
                    header.text("tyndall:part"),
                    0};
    if (!exr.is_unchanged) refuse(file.string(), "damaged: its contents do not match its checksum");
    result.frame = parsed<int>(header.text("imageCounter")).value_or(0);
    FramePart& part = result.part;
    part.display = exr.display, part.low = exr.low, part.size = exr.size;
    part.covered = header.text("tyndall:partCovered") == "1";
    part.colored = exr.attributes.contains("tyndall:partColored");
    read_range(header, part), read_lights(header, part), find_sums(exr, file.string(), part);
    return result;
}
}

PartFile read_part(const std::filesystem::path& file) {
    const ExrFile exr = read_exr_header(file);
    PartFile result = part_in(exr, file);
    if (exr.channel("finished"))
        refuse(file.string(), "is the checkpoint of an unfinished part: render it with --resume");
    return result;
}

FramePart read_rows(const PartFile& part, int first, int count, const SectionSamples& section) {
    FramePart rows = part.part;
    read_sums(read_exr_rows(part.file, first, count), part.file.string(), section, rows);
    return rows;
}

std::filesystem::path checkpoint_name(const std::filesystem::path& part) {
    return std::filesystem::path(part).replace_extension("checkpoint");
}

std::optional<FramePart> read_checkpoint(const std::filesystem::path& file, const std::string& hash,
                                         const Grouping& grouping, std::string& why) {
    if (!std::filesystem::exists(file)) return {};
    try {
        const ExrFile exr = read_exr(file);
        PartFile read = part_in(exr, file);
        if (const Image<float>* finished = exr.channel("finished")) read.part.finished = *finished;
        read_sums(exr, file.string(), {}, read.part);
        if (read.part.finished.empty())
            why = "is not a checkpoint";
        else if (read.hash != hash || read.label != label(grouping) || read.plan_hash != grouping.plan_hash)
            why = "was made from other inputs, settings or plan";
        else
            return std::move(read.part);
    } catch (const Error& error) {
        why = error.what();
    }
    return {};
}

bool is_finished_part(const std::filesystem::path& file, const std::string& hash, const Grouping& grouping,
                      std::string& why) {
    if (!std::filesystem::exists(file)) return false;
    try {
        const ExrFile exr = read_exr_header(file);
        const Header header{exr.attributes, file.string()};
        if (!exr.is_unchanged)
            why = "damaged";
        else if (header.text("tyndall:hash") != hash || header.text("tyndall:part") != label(grouping))
            why = "made from other inputs, settings or plan";
    } catch (const Error& error) {
        why = error.what();
    }
    return why.empty();
}
}
