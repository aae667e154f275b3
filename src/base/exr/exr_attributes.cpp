#include "base/exr/exr_attributes.h"

#include "base/text.h"

#include <ImfBoxAttribute.h>
#include <ImfChromaticitiesAttribute.h>
#include <ImfDoubleAttribute.h>
#include <ImfFloatAttribute.h>
#include <ImfIntAttribute.h>
#include <ImfMatrixAttribute.h>
#include <ImfRationalAttribute.h>
#include <ImfStringAttribute.h>
#include <ImfTimeCodeAttribute.h>
#include <ImfVecAttribute.h>

namespace tyndall {
namespace {
std::string numbers(const float* values, int count) {
    std::string text;
    for (int i = 0; i < count; ++i) text += formatted(i ? " %.9g" : "%.9g", values[i]);
    return text;
}

std::string chromaticities_text(const Imf::Chromaticities& c) {
    const float values[8] = {c.red.x, c.red.y, c.green.x, c.green.y, c.blue.x, c.blue.y, c.white.x, c.white.y};
    return numbers(values, 8);
}

std::string time_code_text(const Imf::TimeCode& t) {
    return formatted("%02d:%02d:%02d:%02d", t.hours(), t.minutes(), t.seconds(), t.frame());
}

template<class T> const T* value_of(const Imf::Attribute& attribute) {
    const auto* typed = dynamic_cast<const Imf::TypedAttribute<T>*>(&attribute);
    return typed ? &typed->value() : nullptr;
}
}

std::string attribute_text(const Imf::Attribute& attribute) {
    if (const auto* v = value_of<std::string>(attribute)) return *v;
    if (const auto* v = value_of<int>(attribute)) return std::to_string(*v);
    if (const auto* v = value_of<float>(attribute)) return numbers(v, 1);
    if (const auto* v = value_of<double>(attribute)) return formatted("%.17g", *v);
    if (const auto* v = value_of<Imath::V2f>(attribute)) return numbers(&v->x, 2);
    if (const auto* v = value_of<Imath::V3f>(attribute)) return numbers(&v->x, 3);
    if (const auto* v = value_of<Imath::M44f>(attribute)) return numbers(v->getValue(), 16);
    if (const auto* v = value_of<Imf::Rational>(attribute)) return std::to_string(v->n) + "/" + std::to_string(v->d);
    if (const auto* v = value_of<Imf::TimeCode>(attribute)) return time_code_text(*v);
    if (const auto* v = value_of<Imf::Chromaticities>(attribute)) return chromaticities_text(*v);
    if (const auto* v = value_of<Imath::Box2i>(attribute))
        return std::to_string(v->min.x) + " " + std::to_string(v->min.y) + " " + std::to_string(v->max.x) + " " +
               std::to_string(v->max.y);
    return std::string("<") + attribute.typeName() + ">";
}
}
