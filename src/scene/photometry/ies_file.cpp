#include "scene/photometry/ies_file.h"

#include "base/error.h"
#include "base/text.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

namespace tyndall {
namespace {
constexpr double meters_per_foot = 0.3048, max_candela = 1e15;

std::string_view trimmed(std::string_view text) {
    const auto blank = [](char c) { return static_cast<unsigned char>(c) <= ' '; };
    while (!text.empty() && blank(text.front())) text.remove_prefix(1);
    while (!text.empty() && blank(text.back())) text.remove_suffix(1);
    return text;
}

std::string upper(std::string_view text) {
    std::string result(text);
    for (char& c : result) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    return result;
}

// What follows "TILT=", which may have blanks around the sign.
std::optional<std::string_view> tilt_of(std::string_view line) {
    if (upper(line.substr(0, 4)) != "TILT") return {};
    line = trimmed(line.substr(4));
    if (!line.starts_with('=')) return {};
    return trimmed(line.substr(1));
}

// Reads the file from start to end, line by line at first, then number by number.
class Reader {
public:
    Reader(std::string_view bytes, std::string_view where) : left_(bytes), where_(where) {}

    // The next line; empty at the end of the file.
    std::optional<std::string_view> line() {
        if (left_.empty()) return {};
        const size_t end = std::min(left_.find_first_of("\r\n"), left_.size());
        const std::string_view text = left_.substr(0, end);
        left_.remove_prefix(end);
        if (left_.starts_with("\r\n"))
            left_.remove_prefix(2);
        else if (!left_.empty())
            left_.remove_prefix(1);
        ++line_;
        return trimmed(text);
    }

    double number(const char* what) {
        skip_blanks();
        if (left_.empty()) fail_at(std::string("the file ends before ") + what);
        const std::string_view text = word();
        const std::optional<double> value = number_of(text);
        if (!value || !std::isfinite(*value))
            fail_at(std::string("expected ") + what + ", found \"" + printable(text, 40) + "\"");
        left_.remove_prefix(text.size());
        return *value;
    }

    // Reads a count of numbers that fit in the rest of the file.
    size_t count(const char* what, double at_least) {
        const double value = number(what);
        if (!(value >= at_least) || value != std::floor(value))
            fail_at(std::string(what) + " is " + shortest_text(value));
        if (value > static_cast<double>(left_.size()) / 2 + 1)
            fail_at(std::string(what) + " is " + shortest_text(value) + ", more than the file has room for");
        return static_cast<size_t>(value);
    }

    std::vector<double> numbers(size_t count, const char* what) {
        if (count > left_.size() / 2 + 1)
            fail_at(std::to_string(count) + " numbers should follow, more than the file has room for");
        std::vector<double> values(count);
        for (double& value : values) value = number(what);
        return values;
    }

    bool at_end() {
        skip_blanks();
        return left_.empty();
    }

    bool at_number() {
        skip_blanks();
        return number_of(word()).has_value();
    }

    [[noreturn]] void fail_at(const std::string& what) const {
        refuse(where_, "line " + std::to_string(line_ + 1) + ": " + what);
    }
    [[noreturn]] void fail(const std::string& what) const { refuse(where_, what); }

private:
    static std::optional<double> number_of(std::string_view text) {
        return parsed<double>(text.starts_with('+') ? text.substr(1) : text);
    }

    std::string_view word() const {
        return left_.substr(0, std::min(left_.find_first_of(" \t\r\n,\f\v"), left_.size()));
    }

    void skip_blanks() {
        while (!left_.empty() && (static_cast<unsigned char>(left_.front()) <= ' ' || left_.front() == ',')) {
            if (left_.front() == '\n') ++line_;
            left_.remove_prefix(1);
        }
    }

    std::string_view left_;
    std::string where_;
    size_t line_ = 0;
};

// "IESNA:LM-63-2002", "IESNA91", "IES:LM-63-2019", in any case; any other first line means LM-63-1986.
std::string standard_of(std::string_view first_line) {
    const std::string line = upper(first_line);
    if (const size_t at = line.find("LM-63-"); line.starts_with("IES") && at != line.npos) return line.substr(at, 10);
    if (line == "IESNA91") return "LM-63-1991";
    return line.starts_with("IESNA95") ? "LM-63-1995" : "LM-63-1986";
}

// The lines before the numbers: the standard, the keywords, the tilt.
void read_head(Reader& reader, IesFile& file) {
    bool first = true;
    while (const std::optional<std::string_view> line = reader.line()) {
        if (first && !line->empty()) file.standard = standard_of(*line), first = false;
        if (const std::optional<std::string_view> tilt = tilt_of(*line)) {
            file.tilt = *tilt;
            return;
        }
        const size_t end = line->find(']');
        if (!line->starts_with('[') || end == line->npos) continue;
        const std::string name(line->substr(1, end - 1)), text(trimmed(line->substr(end + 1)));
        if (name == "MORE" && !file.keywords.empty())
            file.keywords.back().second += " " + text;
        else
            file.keywords.emplace_back(name, text);
    }
    reader.fail("no line \"TILT=\": not an IES photometric file");
}

// Reads the tilt factors, which are not applied, as they depend on the luminaire's mounting.
void read_tilt(Reader& reader, IesFile& file) {
    const std::string word = upper(file.tilt);
    if (word == "NONE") {
        file.tilt = word;
        return;
    }
    if (word != "INCLUDE") {
        file.notes.push_back("its tilt factors, in \"" + printable(file.tilt, 60) + "\", are neither read nor applied");
        return;
    }
    file.tilt = word;
    reader.number("the lamp's position");
    const size_t count = reader.count("the number of tilt angles", 1);
    reader.numbers(count, "a tilt angle");
    const std::vector<double> factors = reader.numbers(count, "a tilt factor");
    file.tilt_factors = {*std::ranges::min_element(factors), *std::ranges::max_element(factors)};
    file.notes.push_back("its tilt factors, " + shortest_text(file.tilt_factors.low) + " to " +
                         shortest_text(file.tilt_factors.high) + ", are not applied: they depend on how it is mounted");
}

// Vertical or horizontal angles, which must ascend.
std::vector<double> read_angles(Reader& reader, size_t count, const char* what, double low, double high) {
    constexpr double closest = 1e-6; // degrees, so that the flux between them can be computed
    const std::vector<double> given = reader.numbers(count, what);
    std::vector<double> angles = given;
    for (size_t i = 0; i < count; ++i) {
        if (i && !(given[i] > given[i - 1] + closest))
            reader.fail_at(std::string(what) + " is not above the previous one; angles must ascend");
        if (given[i] < low - 0.01 || given[i] > high + 0.01)
            reader.fail_at(std::string(what) + " is " + shortest_text(given[i]) + ", not between " +
                           shortest_text(low) + " and " + shortest_text(high));
        angles[i] = std::clamp(given[i], low, high);
        if (i && !(angles[i] > angles[i - 1] + closest))
            reader.fail_at(std::string(what) + " is " + shortest_text(given[i - 1]) + " and the next one " +
                           shortest_text(given[i]) + ": both count as " + shortest_text(angles[i]) +
                           "; angles must ascend");
    }
    return angles;
}

bool near(double a, double b) { return std::abs(a - b) < 0.01; }

// Accepts the ranges of horizontal angles that LM-63 defines: others would have to be guessed.
void check_planes(const Reader& reader, IesFile& file) {
    const size_t count = file.horizontal.size();
    const double first = file.horizontal.front(), last = file.horizontal.back();
    if (file.type != Photometry::type_c) {
        if (count < 2) reader.fail("photometry of type A or B needs more than one horizontal angle");
        return;
    }
    if (count == 1) return;
    const bool known = (near(first, 0) && (near(last, 90) || near(last, 180) || near(last, 360))) ||
                       (near(first, 90) && near(last, 270));
    if (known) return;
    if (!near(first, 0) || last < 180)
        reader.fail("the horizontal angles go from " + shortest_text(first) + " to " + shortest_text(last) +
                    "; supported: 0, 0 to 90, 0 to 180, 90 to 270 and 0 to 360");
    file.notes.push_back("the horizontal angles end at " + shortest_text(last) +
                         "; the first plane is repeated at 360");
    file.horizontal.push_back(360);
    for (size_t i = 0; i < file.vertical.size(); ++i) file.candela.push_back(file.candela[i]);
}

void read_candela(Reader& reader, double factor, IesFile& file) {
    file.candela = reader.numbers(file.vertical.size() * file.horizontal.size(), "a candela value");
    size_t below = 0;
    for (double& value : file.candela) {
        below += value < 0;
        value = std::max(value * factor, 0.0);
        if (!(value <= max_candela)) reader.fail_at("a candela value is over 1e15");
    }
    if (below) file.notes.push_back(count_text(below, "candela value") + " below 0 clamped to 0");
    if (!reader.at_end() && reader.at_number())
        reader.fail_at(
            "numbers follow the last candela value: an angle count is wrong, or numbers have decimal commas");
    if (!reader.at_end()) file.notes.push_back("text after the candela values is ignored");
}

// A luminaire cannot emit more light than its lamps: then a number in the file is wrong, mostly the multiplier.
void compare_with_lamps(IesFile& file) {
    constexpr double tolerated = 1.2;
    const double lamps = file.absolute() ? 0 : file.lamps * file.lumens_per_lamp, lumens = zonal_lumens(file);
    if (!(lamps > 0) || !(lumens > tolerated * lamps)) return;
    file.notes.push_back(formatted("its candela values give %.4g lumens, %.3g %% of the %g lumens of its lamps", lumens,
                                   100 * lumens / lamps, lamps));
}

void read_body(Reader& reader, IesFile& file) {
    file.lamps = reader.number("the number of lamps"), file.lumens_per_lamp = reader.number("the lumens per lamp");
    file.multiplier = reader.number("the candela multiplier");
    const size_t vertical = reader.count("the number of vertical angles", 2);
    const size_t horizontal = reader.count("the number of horizontal angles", 1);
    const double type = reader.number("the photometric type"), units = reader.number("the type of units");
    if (type != 1 && type != 2 && type != 3)
        reader.fail_at("the photometric type is " + shortest_text(type) + "; supported: 1 (C), 2 (B) and 3 (A)");
    file.type = static_cast<Photometry>(static_cast<int>(type));
    for (int axis = 0; axis < 3; ++axis)
        file.size[axis] = reader.number("the size of the luminaire") * (units == 1 ? meters_per_foot : 1);
    file.ballast = reader.number("the ballast factor");
    // The ballast-lamp factor until 1995, always 1 in 2002, the code of the file generation type in 2019.
    const double third = reader.number("the ballast-lamp factor");
    file.standard == "LM-63-2019" ? file.generation = third : file.ballast *= third;
    file.watts = reader.number("the input watts");
    if (!(file.multiplier >= 0) || !(file.ballast >= 0))
        reader.fail_at("the candela multiplier or the ballast factor is below 0");

    const bool c = file.type == Photometry::type_c;
    file.vertical = read_angles(reader, vertical, "a vertical angle", c ? 0 : -90, c ? 180 : 90);
    file.horizontal = read_angles(reader, horizontal, "a horizontal angle", c ? 0 : -90, c ? 360 : 90);
    read_candela(reader, file.multiplier * file.ballast, file);
    check_planes(reader, file);
    if (!(file.peak() > 0)) reader.fail("all candela values are 0: the file gives no light");
    compare_with_lamps(file);
}
}

double IesFile::peak() const { return candela.empty() ? 0 : *std::ranges::max_element(candela); }

IesFile read_ies(std::string_view bytes, std::string_view where) {
    if (bytes.starts_with("\xef\xbb\xbf")) bytes.remove_prefix(3);
    if (const size_t end = bytes.find('\x1a'); end != bytes.npos) bytes = bytes.substr(0, end); // DOS end-of-file mark
    Reader reader(bytes, where);
    IesFile file;
    read_head(reader, file);
    read_tilt(reader, file);
    read_body(reader, file);
    return file;
}
}
