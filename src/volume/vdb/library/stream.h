// Stream buffers over memory for the OpenVDB library, without copies.
#pragma once
#include <streambuf>
#include <string_view>

namespace tyndall {
// Input; the stream fails at the end of the bytes.
class ByteSource : public std::streambuf {
public:
    explicit ByteSource(std::string_view bytes) {
        char* begin = const_cast<char*>(bytes.data()); // never written to
        setg(begin, begin, begin + bytes.size());
    }
    size_t taken() const { return static_cast<size_t>(gptr() - eback()); }

protected:
    pos_type seekoff(off_type offset, std::ios_base::seekdir from, std::ios_base::openmode) override {
        const char* base = from == std::ios_base::beg ? eback() : from == std::ios_base::cur ? gptr() : egptr();
        const off_type at = base - eback() + offset;
        if (at < 0 || at > egptr() - eback()) return pos_type(off_type(-1));
        setg(eback(), eback() + at, egptr());
        return at;
    }
    pos_type seekpos(pos_type position, std::ios_base::openmode mode) override {
        return seekoff(position, std::ios_base::beg, mode);
    }
};

// Output; the stream fails if the buffer is full.
class ByteSink : public std::streambuf {
public:
    ByteSink(char* room, size_t bytes) { setp(room, room + bytes); }
    size_t size() const { return static_cast<size_t>(pptr() - pbase()); }
};
}
