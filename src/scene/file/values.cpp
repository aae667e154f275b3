#include "scene/file/values.h"

#include "base/error.h"
#include "base/json/json_pointer.h"

#include <glm/gtc/quaternion.hpp>

#include <cassert>

namespace tyndall {
namespace {
constexpr int steps_between_keys = 16;

Interpolation interpolation_named(std::string_view name) {
    if (name == "step") return Interpolation::step;
    return name == "smooth" ? Interpolation::smooth : Interpolation::linear;
}

template<class T, class Read> Keyed<T> keyed(const Field& field, const Read& read) {
    if (field.json->kind != Json::Kind::object) return read(field);
    const Field keys = field.member("keys");
    Keyed<T> result;
    result.values.clear();
    for (size_t i = 0; i < keys.json->items.size(); ++i) {
        const Field key = keys.item(i);
        result.times.push_back(read_number(key.item(0)));
        result.values.push_back(read(key.item(1)));
        if (i && !(result.times[i] > result.times[i - 1])) refuse(key.item(0), "key times must increase");
    }
    result.interpolation = interpolation_named(field.json->string_or("interpolation", "linear"));
    result.loop = field.json->boolean_or("loop", false);
    return result;
}

quat turned(vec3 degrees) {
    const vec3 angle = glm::radians(degrees);
    return glm::angleAxis(angle.z, vec3(0, 0, 1)) * glm::angleAxis(angle.y, vec3(0, 1, 0)) *
           glm::angleAxis(angle.x, vec3(1, 0, 0));
}

double length(const Keyed<vec3>& value) { return static_cast<double>(value.times.back()) - value.times.front(); }
}

std::string Field::location() const { return json_location(file, pointer); }

Field Field::member(std::string_view key) const {
    const Json* value = json->find(key);
    return value ? Field{value, file, json_pointer(pointer, key)} : Field{};
}

Field Field::item(size_t index) const {
    assert(index < json->items.size());
    return {&json->items[index], file, json_pointer(pointer, index)};
}

void refuse(const Field& field, std::string_view what) { refuse(field.location(), what); }

float read_number(const Field& field) {
    const float value = static_cast<float>(field.json->number);
    if (!std::isfinite(value)) refuse(field, "the number is too large");
    return value;
}

vec3 read_vector(const Field& field) {
    return {read_number(field.item(0)), read_number(field.item(1)), read_number(field.item(2))};
}

dvec3 read_position(const Field& field) {
    if (field.json->kind == Json::Kind::object) return read_position(field.member("keys").item(0).item(1));
    dvec3 location;
    for (int axis = 0; axis < 3; ++axis) location[axis] = field.item(static_cast<size_t>(axis)).json->number;
    return location;
}

vec3 read_color(const Field& field) {
    return field.json->kind == Json::Kind::number ? vec3(read_number(field)) : read_vector(field);
}

Keyed<float> keyed_number(const Field& field) { return keyed<float>(field, read_number); }
Keyed<float> keyed_degrees(const Field& field) { return keyed<float>(field, read_degrees); }
Keyed<float> keyed_height(const Field& field, double origin) {
    return keyed<float>(field, [&](const Field& height) { return static_cast<float>(height.json->number - origin); });
}
Keyed<vec3> keyed_vector(const Field& field) { return keyed<vec3>(field, read_vector); }
Keyed<vec3> keyed_position(const Field& field, dvec3 origin) {
    return keyed<vec3>(field, [&](const Field& location) { return vec3(read_position(location) - origin); });
}
Keyed<vec3> keyed_color(const Field& field) { return keyed<vec3>(field, read_color); }

Keyed<quat> rotation_of(const Keyed<vec3>& degrees) {
    Keyed<quat> result;
    result.loop = degrees.loop;
    result.values.clear();
    if (degrees.constant() || degrees.interpolation == Interpolation::step) {
        result.times = degrees.times, result.interpolation = degrees.interpolation;
        for (const vec3 value : degrees.values) result.values.push_back(turned(value));
        return result;
    }

    // At most 10 degrees per step, so that the shorter arc between two steps is the intended one.
    for (size_t i = 0; i + 1 < degrees.times.size(); ++i) {
        const vec3 turn = glm::abs(degrees.values[i + 1] - degrees.values[i]);
        const double turns = std::min(std::ceil(static_cast<double>(turn.x + turn.y + turn.z) / 10), 100000.0);
        const int steps = std::max(degrees.interpolation == Interpolation::smooth ? 2 * steps_between_keys : 1,
                                   static_cast<int>(turns));
        for (int step = 0; step < steps; ++step) {
            const double t =
                degrees.times[i] + step * (static_cast<double>(degrees.times[i + 1]) - degrees.times[i]) / steps;
            const float time = static_cast<float>(t);
            if (!result.times.empty() && !(time > result.times.back())) continue;
            result.times.push_back(time), result.values.push_back(turned(degrees.at(time)));
        }
    }
    result.times.push_back(degrees.times.back()), result.values.push_back(turned(degrees.values.back()));
    return result;
}

Keyed<vec3> difference(const Keyed<vec3>& a, const Keyed<vec3>& b, const Field& field) {
    if (a.constant() && b.constant()) return a.values[0] - b.values[0];
    const Keyed<vec3>& leading = a.constant() ? b : a;
    const bool both = !a.constant() && !b.constant();
    if (both && (a.loop || b.loop) &&
        !(a.loop == b.loop && a.times.front() == b.times.front() && length(a) == length(b)))
        refuse(field, "the animations of position and target must loop over the same time");

    std::vector<float> times = leading.times;
    if (both) times.insert(times.end(), b.times.begin(), b.times.end());
    std::sort(times.begin(), times.end());
    times.erase(std::unique(times.begin(), times.end()), times.end());

    // Animations that match keep their interpolation; others become many short linear segments, with sharp steps.
    const bool straight = both && a.interpolation == Interpolation::linear && b.interpolation == Interpolation::linear;
    const bool alike = !both || (a.interpolation == b.interpolation && a.times == b.times) || straight;
    const bool jumps = !alike && (a.interpolation == Interpolation::step || b.interpolation == Interpolation::step);
    const int steps = alike ? 1 : steps_between_keys;
    Keyed<vec3> result;
    result.loop = leading.loop;
    result.interpolation = alike ? leading.interpolation : Interpolation::linear;
    for (size_t i = 0; i < times.size(); ++i) {
        const float just_before = std::nextafter(times[i], -infinity);
        if (jumps && i && just_before > result.times.back()) result.times.push_back(just_before);
        const double gap = i + 1 < times.size() ? static_cast<double>(times[i + 1]) - times[i] : 0;
        for (int step = 0; step < (gap > 0 ? steps : 1); ++step) {
            const float time = static_cast<float>(times[i] + step * gap / steps);
            if (result.times.empty() || time > result.times.back()) result.times.push_back(time);
        }
    }

    // At the last key of a loop, use that key's value, not the first one's, to which the time wraps.
    const auto value_at = [](const Keyed<vec3>& value, float time) {
        return !value.constant() && time == value.times.back() ? value.values.back() : value.at(time);
    };
    result.values.clear();
    for (const float time : result.times) result.values.push_back(value_at(a, time) - value_at(b, time));
    return result;
}
}
