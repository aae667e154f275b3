// Converts animations to keys of nodes. They play together, except those that animate what an earlier one does.
#include "base/error.h"
#include "scene/gltf/document.h"

#include <algorithm>
#include <set>

namespace tyndall {
namespace {
Interpolation interpolation_named(std::string_view name) {
    if (name == "STEP") return Interpolation::step;
    return name == "CUBICSPLINE" ? Interpolation::cubic : Interpolation::linear;
}

vec3 element(const float* values, const vec3&) { return {values[0], values[1], values[2]}; }
float element(const float* values, float) { return values[0]; }
quat element(const float* values, const quat&) { return {values[3], values[0], values[1], values[2]}; }

// The data of a sampler: times, and for each time `many` values of `components` components; three times as many for
// splines.
struct Samples {
    Interpolation interpolation;
    std::vector<float> times, values;
    size_t stride, many, components;
};
Samples samples_of(GltfDocument& document, const tinygltf::AnimationSampler& sampler, int components, size_t many,
                   const std::string& pointer) {
    const Interpolation interpolation = interpolation_named(sampler.interpolation);
    Samples samples{interpolation,
                    gltf_floats(document, sampler.input, 1, pointer + "/input"),
                    gltf_floats(document, sampler.output, components, pointer + "/output"),
                    interpolation == Interpolation::cubic ? size_t{3} : size_t{1},
                    many,
                    static_cast<size_t>(components)};
    const size_t has = samples.values.size() / samples.components,
                 needed = samples.times.size() * samples.stride * many;
    if (has != needed)
        refuse(document.location(pointer + "/output"),
               "has " + std::to_string(has) + " elements, but " + std::to_string(needed) + " are needed");
    for (const float value : samples.values)
        if (!std::isfinite(value)) refuse(document.location(pointer + "/output"), "has a non-finite value");
    for (const float time : samples.times)
        if (!std::isfinite(time)) refuse(document.location(pointer + "/input"), "has a non-finite time");
    return samples;
}

// The keys of one of the values. Skips keys whose time does not increase.
template<class T> Keyed<T> keys_of(GltfDocument& document, const Samples& samples, size_t index = 0) {
    Keyed<T> keys;
    keys.interpolation = samples.interpolation;
    keys.values.clear();
    for (size_t i = 0; i < samples.times.size(); ++i) {
        if (!keys.times.empty() && samples.times[i] <= keys.times.back()) {
            document.count("keys whose time does not increase are ignored");
            continue;
        }
        keys.times.push_back(samples.times[i]);
        for (size_t part = 0; part < samples.stride; ++part) {
            const size_t location = (i * samples.stride + part) * samples.many + index;
            keys.values.push_back(element(&samples.values[location * samples.components], T()));
        }
    }
    return keys;
}

// Normalizes the values, but not the tangents of a spline.
void make_unit(Keyed<quat>& keys) {
    const size_t stride = keys.interpolation == Interpolation::cubic ? 3 : 1;
    for (size_t i = stride / 2; i < keys.values.size(); i += stride) keys.values[i] = glm::normalize(keys.values[i]);
}

template<class T> void play(GltfDocument& document, const Keyed<T>& keys, Keyed<T>& target) {
    if (keys.times.empty()) return document.count("animations without keys are ignored");
    if (!target.times.empty()) return document.count("animations of properties that are already animated are ignored");
    target = keys;
}

// Animates the morph targets of all meshes at a node.
void play_weights(GltfDocument& document, int node, const tinygltf::AnimationSampler& sampler,
                  const std::string& pointer) {
    for (const int instance : document.instances[node]) {
        std::vector<Keyed<float>>& weights = document.scene->instances[instance].target_weights;
        if (weights.empty()) continue;
        const Samples samples = samples_of(document, sampler, 1, weights.size(), pointer);
        for (size_t i = 0; i < weights.size(); ++i) play(document, keys_of<float>(document, samples, i), weights[i]);
    }
}

void add_channel(GltfDocument& document, const tinygltf::AnimationChannel& channel,
                 const tinygltf::AnimationSampler& sampler, const std::string& pointer) {
    const int index = channel.target_node < 0 ? -1 : document.nodes[channel.target_node];
    if (index < 0) return;
    if (channel.target_path == "weights") return play_weights(document, channel.target_node, sampler, pointer);
    Node& node = document.scene->nodes[index];
    if (node.matrix) return document.count("animations of nodes with a matrix are ignored");
    if (channel.target_path == "translation") {
        play(document, keys_of<vec3>(document, samples_of(document, sampler, 3, 1, pointer)), node.translation);
        node.remainder = dvec3(0);
    } else if (channel.target_path == "scale")
        play(document, keys_of<vec3>(document, samples_of(document, sampler, 3, 1, pointer)), node.scale);
    else if (channel.target_path == "rotation") {
        Keyed<quat> keys = keys_of<quat>(document, samples_of(document, sampler, 4, 1, pointer));
        make_unit(keys);
        play(document, keys, node.rotation);
    } else {
        document.count("animations of unknown properties are ignored");
    }
}
}

namespace {
using Property = std::pair<int, std::string>; // a node of the glTF and the path of a channel

std::set<Property> properties_of(const GltfDocument& document, const tinygltf::Animation& animation) {
    std::set<Property> properties;
    for (const tinygltf::AnimationChannel& channel : animation.channels)
        if (channel.target_node >= 0 && document.nodes[channel.target_node] >= 0)
            properties.insert({channel.target_node, channel.target_path});
    return properties;
}

bool is_chosen(const GltfDocument& document, const std::string& name) {
    const auto& chosen = document.options.animations;
    return !chosen || std::ranges::count(*chosen, name) > 0;
}
}

void add_gltf_animations(GltfDocument& document) {
    std::map<Property, std::string> played; // and the name of the animation
    for (size_t a = 0; a < document.model.animations.size(); ++a) {
        const tinygltf::Animation& animation = document.model.animations[a];
        const std::string name = animation.name.empty() ? "animation " + std::to_string(a) : animation.name;
        document.scene->animations.push_back(name);
        if (!is_chosen(document, name)) continue;

        // Parts of two clips give poses of neither, so a clip plays as a whole or not at all.
        const std::set<Property> properties = properties_of(document, animation);
        const auto shared = std::ranges::find_if(properties, [&](const auto& one) { return played.contains(one); });
        if (shared != properties.end()) {
            document.warn(gltf_pointer("animations", a), "animation " + quote_json(name) +
                                                             " is not played: it animates what " +
                                                             quote_json(played[*shared]) + " animates");
            continue;
        }
        for (const Property& property : properties) played[property] = name;
        for (const tinygltf::AnimationChannel& channel : animation.channels)
            add_channel(document, channel, animation.samplers[channel.sampler],
                        gltf_pointer("animations", a, "samplers/") + std::to_string(channel.sampler));
    }
}
}
