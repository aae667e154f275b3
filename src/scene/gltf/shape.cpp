#include "scene/gltf/shape.h"

#include "base/error.h"
#include "base/json/json_pointer.h"
#include "base/text.h"
#include "scene/gltf/shape_rules.h"

#include <cmath>

namespace tyndall {
namespace {
using gltf_schema::Rule, gltf_schema::ValueType;

class SchemaCheck {
public:
    SchemaCheck(const Json& document, std::string_view file) : document_(document), file_(file) {}

    void object(const Json& value, std::span<const Rule> rules, const std::string& pointer) const {
        if (value.kind != Json::Kind::object) wrong(value, pointer, "an object");
        for (const Rule& rule : rules) {
            const Json* member = value.find(rule.name);
            if (member) {
                check(*member, rule, json_pointer(pointer, rule.name));
            } else if (rule.required) {
                refuse(json_location(file_, pointer), "\"" + std::string(rule.name) + "\" is missing");
            }
        }
    }

private:
    [[noreturn]] void wrong(const Json& value, const std::string& pointer, const std::string& expected) const {
        std::string got = value.kind == Json::Kind::object  ? "an object"
                          : value.kind == Json::Kind::array ? "an array"
                                                            : printable(format_json(value), 60);
        refuse(json_location(file_, pointer), "expected " + expected + ", got " + got);
    }

    void check(const Json& value, const Rule& rule, const std::string& pointer) const {
        switch (rule.type) {
        case ValueType::flag:
            if (value.kind != Json::Kind::boolean) wrong(value, pointer, "true or false");
            return;
        case ValueType::text:
            if (value.kind != Json::Kind::string) wrong(value, pointer, "a string");
            return;
        case ValueType::integer:
            return integer(value, rule.low, rule.high, pointer);
        case ValueType::number:
            return number(value, rule.low, rule.high, pointer);
        case ValueType::positive:
            if (value.kind != Json::Kind::number || !(value.number > 0 && value.number <= rule.high))
                wrong(value, pointer, "a number above 0, at most " + text_of(rule.high));
            return;
        case ValueType::numbers:
            array(value, pointer, "an array of numbers");
            if (rule.length && value.items.size() != rule.length)
                refuse(json_location(file_, pointer), "expected " + std::to_string(rule.length) + " numbers, got " +
                                                          std::to_string(value.items.size()));
            for (size_t i = 0; i < value.items.size(); ++i)
                number(value.items[i], rule.low, rule.high, json_pointer(pointer, i));
            return;
        case ValueType::one_of:
            for (const int known : rule.values)
                if (value.kind == Json::Kind::number && value.number == known) return;
            wrong(value, pointer, "one of " + list(rule.values));
        case ValueType::words:
            for (const std::string_view word : rule.words)
                if (value.kind == Json::Kind::string && value.string == word) return;
            wrong(value, pointer, "one of " + list(rule.words));
        case ValueType::index:
            return index(value, rule.collection, pointer);
        case ValueType::indices:
            array(value, pointer, "an array of indices");
            for (size_t i = 0; i < value.items.size(); ++i)
                index(value.items[i], rule.collection, json_pointer(pointer, i));
            return;
        case ValueType::index_map:
            return index_map(value, rule.collection, pointer);
        case ValueType::index_maps:
            array(value, pointer, "an array of objects");
            for (size_t i = 0; i < value.items.size(); ++i)
                index_map(value.items[i], rule.collection, json_pointer(pointer, i));
            return;
        case ValueType::object:
            return object(value, rule.fields, pointer);
        case ValueType::objects:
            array(value, pointer, "an array of objects");
            for (size_t i = 0; i < value.items.size(); ++i)
                object(value.items[i], rule.fields, json_pointer(pointer, i));
            return;
        }
    }

    void array(const Json& value, const std::string& pointer, const char* expected) const {
        if (value.kind != Json::Kind::array) wrong(value, pointer, expected);
    }

    void number(const Json& value, double low, double high, const std::string& pointer) const {
        if (value.kind != Json::Kind::number || !(value.number >= low && value.number <= high))
            wrong(value, pointer, "a number from " + text_of(low) + " to " + text_of(high));
    }

    void integer(const Json& value, double low, double high, const std::string& pointer) const {
        if (value.kind != Json::Kind::number || !(value.number >= low && value.number <= high) ||
            value.number != std::floor(value.number))
            wrong(value, pointer, "an integer from " + text_of(low) + " to " + text_of(high));
    }

    void index(const Json& value, std::string_view collection, const std::string& pointer) const {
        const Json* all = gltf_collection(document_, collection);
        const size_t count = all ? all->items.size() : 0;
        if (value.kind == Json::Kind::number && value.number >= 0 && value.number < static_cast<double>(count) &&
            value.number == std::floor(value.number))
            return;
        const std::string name = collection == "profiles" ? "\"lights\" of EXT_lights_ies" : quote_json(collection);
        wrong(value, pointer, "an index into " + name + ", which has " + count_text(count, "element"));
    }

    void index_map(const Json& value, std::string_view collection, const std::string& pointer) const {
        if (value.kind != Json::Kind::object) wrong(value, pointer, "an object");
        for (const auto& [name, item] : value.members) index(item, collection, json_pointer(pointer, name));
    }

    static std::string text_of(double value) { return format_json(value); }
    static std::string list(std::span<const int> values) {
        std::string text;
        for (const int value : values) text += (text.empty() ? "" : ", ") + std::to_string(value);
        return text;
    }
    static std::string list(std::span<const std::string_view> words) {
        std::string text;
        for (const std::string_view word : words) text += (text.empty() ? "" : ", ") + quote_json(word);
        return text;
    }

    const Json& document_;
    std::string_view file_;
};
}

const Json* gltf_collection(const Json& document, std::string_view name) {
    const Json* value = document.find(name);
    if (name == "lights" || name == "profiles") {
        const Json* extensions = document.find("extensions");
        const Json* own =
            extensions ? extensions->find(name == "lights" ? "KHR_lights_punctual" : "EXT_lights_ies") : nullptr;
        value = own ? own->find("lights") : nullptr;
    }
    return value && value->kind == Json::Kind::array ? value : nullptr;
}

namespace {
const std::vector<Json>& items_of(const Json& document, std::string_view collection) {
    static const std::vector<Json> none;
    const Json* array = gltf_collection(document, collection);
    return array ? array->items : none;
}
}

void check_gltf_schema(const Json& document, std::string_view file) {
    SchemaCheck(document, file).object(document, gltf_schema::root, "");
}

void check_gltf_needs(const Json& document, std::string_view file) {
    const auto complain = [&](std::string_view collection, size_t i, const std::string& what) {
        const std::string_view parent = collection == "lights" ? "/extensions/KHR_lights_punctual" : "";
        refuse(json_location(file, json_pointer(json_pointer(parent, collection), i)), what);
    };
    const auto need_own_object = [&](std::string_view collection, std::string_view only) {
        const std::vector<Json>& all = items_of(document, collection);
        for (size_t i = 0; i < all.size(); ++i) {
            const std::string type = all[i].string_or("type", "");
            if ((only.empty() || only == type) && !all[i].has(type))
                complain(collection, i, quote_json(type) + " is missing");
        }
    };
    need_own_object("cameras", "");
    need_own_object("lights", "spot");

    const std::vector<Json>& views = items_of(document, "bufferViews");
    for (size_t i = 0; i < views.size(); ++i)
        if (std::fmod(views[i].number_or("byteStride", 4), 4) != 0)
            complain("bufferViews", i, "byteStride is not a multiple of 4");
    const std::vector<Json>&meshes = items_of(document, "meshes"), &accessors = items_of(document, "accessors");
    for (size_t i = 0; i < meshes.size(); ++i) {
        const std::vector<Json>& primitives = meshes[i].find("primitives")->items;
        for (size_t k = 0; k < primitives.size(); ++k) {
            const Json* indices = primitives[k].find("indices");
            if (indices && !accessors[static_cast<size_t>(indices->number)].has("bufferView"))
                refuse(json_location(file,
                                     "/meshes/" + std::to_string(i) + "/primitives/" + std::to_string(k) + "/indices"),
                       "accessor " + format_json(*indices) + " has no buffer view");
        }
    }
}
}
