#include "viewer/editing/json_text.h"

#include "base/error.h"
#include "base/json/json.h"
#include "base/json/json_pointer.h"
#include "base/text.h"

#include <algorithm>
#include <vector>

namespace tyndall {
namespace {
[[noreturn]] void fail_at(size_t offset) { refuse("byte " + std::to_string(offset), "not valid JSON"); }

bool is_blank(char c) { return c == ' ' || c == '\t'; }
bool is_space(char c) { return is_blank(c) || c == '\n' || c == '\r'; }
bool all_blank(std::string_view text) { return std::ranges::all_of(text, is_blank); }

size_t skip_comment(std::string_view text, size_t at) {
    const bool line = text.substr(at, 2) == "//";
    const size_t end = line ? text.find_first_of("\r\n", at) : text.find("*/", at + 2);
    return end == text.npos ? text.size() : line ? end : end + 2;
}

bool at_comment(std::string_view text, size_t at) { return text.substr(at, 2) == "//" || text.substr(at, 2) == "/*"; }

// The position after whitespace and comments.
size_t skip_space(std::string_view text, size_t at) {
    while (at < text.size() && (is_space(text[at]) || at_comment(text, at)))
        at = is_space(text[at]) ? at + 1 : skip_comment(text, at);
    return at;
}

size_t skip_string(std::string_view text, size_t at) {
    for (size_t i = at + 1; i < text.size(); ++i) {
        if (text[i] == '"') return i + 1;
        if (text[i] == '\\') ++i;
    }
    fail_at(at);
}

size_t skip_word(std::string_view text, size_t at) {
    const size_t end = std::min(text.find_first_of(" \t\r\n{}[],:/\"", at), text.size());
    if (end == at) fail_at(at);
    return end;
}

// The position after the value that begins at `at`. Brackets are only counted: in parsed text they match.
size_t skip_value(std::string_view text, size_t at) {
    for (int depth = 0;;) {
        if (at >= text.size()) fail_at(at);
        const char c = text[at];
        const bool opens = c == '{' || c == '[', closes = c == '}' || c == ']';
        depth += opens - closes;
        if (depth < 0) fail_at(at);
        if (c == '"')
            at = skip_string(text, at);
        else if (opens || closes || (depth > 0 && (c == ',' || c == ':')))
            ++at;
        else
            at = skip_word(text, at);
        if (depth == 0) return at;
        at = skip_space(text, at);
    }
}

struct Element {
    TextSpan key, value; // empty key for items of an array
    size_t begin = 0;    // of the key, or of the value
};

// Members or items of the value at a span; empty for a scalar.
std::vector<Element> elements_of(std::string_view text, TextSpan container) {
    std::vector<Element> elements;
    const char bracket = text[container.begin];
    if (bracket != '{' && bracket != '[') return elements;
    size_t at = skip_space(text, container.begin + 1);
    while (at + 1 < container.end) {
        Element element;
        element.begin = at;
        if (bracket == '{') {
            if (text[at] != '"') fail_at(at);
            element.key = {at, skip_string(text, at)};
            at = skip_space(text, element.key.end);
            if (at >= container.end || text[at] != ':') fail_at(at);
            at = skip_space(text, at + 1);
        }
        element.value = {at, skip_value(text, at)};
        elements.push_back(element);
        at = skip_space(text, element.value.end);
        if (text[at] == ',') at = skip_space(text, at + 1);
    }
    return elements;
}

// A key without quotes and with its escapes decoded.
std::string plain_key(std::string_view quoted) {
    const std::string_view inside = quoted.substr(1, quoted.size() - 2);
    return inside.find('\\') == inside.npos ? std::string(inside) : parse_json(quoted, "a key").string;
}

std::optional<TextSpan> child(std::string_view text, TextSpan parent, std::string_view token) {
    const std::vector<Element> elements = elements_of(text, parent);
    if (text[parent.begin] == '[') {
        const std::optional<size_t> index = parsed<size_t>(token);
        return index && *index < elements.size() ? std::optional(elements[*index].value) : std::nullopt;
    }
    const std::string key = json_pointer_key(token);
    for (const Element& element : elements)
        if (plain_key(element.key.of(text)) == key) return element.value;
    return {};
}

TextSpan root_of(std::string_view text) {
    const size_t begin = skip_space(text, text.starts_with("\xef\xbb\xbf") ? 3 : 0);
    return {begin, skip_value(text, begin)};
}

std::string replaced(std::string_view text, TextSpan span, std::string_view by) {
    return std::string(text.substr(0, span.begin)).append(by).append(text.substr(span.end));
}

// The leading whitespace of the line at a position.
std::string_view margin_at(std::string_view text, size_t offset) {
    const size_t start = text.substr(0, offset).rfind('\n') + 1; // npos + 1 is 0
    size_t end = start;
    while (end < offset && is_blank(text[end])) ++end;
    return text.substr(start, end - start);
}

bool on_own_line(std::string_view text, size_t offset) {
    const size_t line = text.substr(0, offset).rfind('\n');
    return line != text.npos && all_blank(text.substr(line + 1, offset - line - 1));
}

std::string colon_of(std::string_view text, const std::vector<Element>& elements) {
    if (!elements.empty()) {
        const Element& last = elements.back();
        const std::string_view colon = text.substr(last.key.end, last.value.begin - last.key.end);
        if (colon.find_first_not_of(" \t:") == colon.npos) return std::string(colon);
    }
    return text.find("\": ") == text.npos && text.find("\":") != text.npos ? ":" : ": ";
}

// The whitespace between a comma and the next element on the same line.
std::string gap_between(std::string_view text, const std::vector<Element>& elements) {
    if (elements.size() > 1) {
        const Element& last = elements.back();
        const size_t end = elements[elements.size() - 2].value.end;
        const std::string_view between = text.substr(end, last.begin - end);
        if (between.starts_with(',') && all_blank(between.substr(1))) return std::string(between.substr(1));
    }
    const bool object = elements.back().key.end > 0;
    const bool wide = colon_of(text, object ? elements : std::vector<Element>{}).size() > 1;
    return wide || (!object && text.find(", ") != text.npos) ? " " : "";
}

std::string into_empty(std::string_view text, TextSpan container, std::string_view element) {
    const TextSpan inner{container.begin + 1, container.end - 1};
    const std::string pad = text[container.begin] == '{' && colon_of(text, {}).size() > 1 ? " " : "";
    if (std::ranges::all_of(inner.of(text), is_space)) return replaced(text, inner, pad + std::string(element) + pad);
    return replaced(text, {inner.begin, inner.begin}, " " + std::string(element));
}

// Inserts after the last element: the comma directly after it, the new element after its comments.
std::string appended(std::string_view text, TextSpan container, const std::vector<Element>& elements,
                     std::string_view element) {
    const Element& last = elements.back();
    size_t tail = last.value.end;
    bool behind_line_comment = false;
    for (size_t at = tail; at + 1 < container.end;) {
        if (!at_comment(text, at)) {
            ++at;
            continue;
        }
        behind_line_comment = text[at + 1] == '/';
        tail = at = skip_comment(text, at);
    }
    const bool breaks = behind_line_comment || on_own_line(text, last.begin);
    const std::string gap =
        breaks ? line_end_of(text) + std::string(margin_at(text, last.begin)) : gap_between(text, elements);
    std::string result(text.substr(0, last.value.end));
    result.append(",").append(text.substr(last.value.end, tail - last.value.end)).append(gap).append(element);
    return result.append(text.substr(tail));
}

std::string inserted(std::string_view text, TextSpan container, const std::vector<Element>& elements, size_t index,
                     std::string_view element) {
    if (elements.empty()) return into_empty(text, container, element);
    if (index >= elements.size()) return appended(text, container, elements, element);
    const size_t offset = elements[index].begin;
    const std::string gap = on_own_line(text, offset) ? line_end_of(text) + std::string(margin_at(text, offset))
                                                      : gap_between(text, elements);
    return replaced(text, {offset, offset}, std::string(element) + "," + gap);
}
}

std::optional<TextSpan> find_json(std::string_view text, std::string_view pointer) {
    std::optional<TextSpan> span = root_of(text);
    while (span && !pointer.empty()) {
        const size_t end = std::min(pointer.find('/', 1), pointer.size());
        span = child(text, *span, pointer.substr(1, end - 1));
        pointer.remove_prefix(end);
    }
    return span;
}

std::string with_json(std::string_view text, std::string_view pointer, std::string_view value) {
    if (const auto span = find_json(text, pointer)) return replaced(text, *span, value);
    const size_t slash = pointer.rfind('/');
    const std::string_view parent = pointer.substr(0, slash), token = pointer.substr(slash + 1);
    const std::string key = quote_json(json_pointer_key(token));
    const std::optional<TextSpan> container = find_json(text, parent);
    if (!container) {
        const std::string colon = colon_of(text, {}), pad = colon.size() > 1 ? " " : "";
        return with_json(text, parent, "{" + pad + key + colon + std::string(value) + pad + "}");
    }
    const std::vector<Element> elements = elements_of(text, *container);
    if (text[container->begin] == '{')
        return inserted(text, *container, elements, elements.size(),
                        key + colon_of(text, elements) + std::string(value));
    if (text[container->begin] != '[' || parsed<size_t>(token) != elements.size())
        refuse(std::string(pointer), "not found in the file");
    return inserted(text, *container, elements, elements.size(), value);
}

std::string with_json_item(std::string_view text, std::string_view array, size_t index, std::string_view value) {
    const std::optional<TextSpan> container = find_json(text, array);
    if (!container || text[container->begin] != '[') refuse(std::string(array), "no such list in the file");
    return inserted(text, *container, elements_of(text, *container), index, value);
}

std::string indentation_of(std::string_view text) {
    const std::vector<Element> members = elements_of(text, root_of(text));
    if (members.empty() || !on_own_line(text, members[0].begin)) return "";
    return std::string(margin_at(text, members[0].begin));
}

std::string line_end_of(std::string_view text) {
    const size_t end = text.find('\n');
    return end != text.npos && end > 0 && text[end - 1] == '\r' ? "\r\n" : "\n";
}
}
