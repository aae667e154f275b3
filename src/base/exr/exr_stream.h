// Lets the OpenEXR library read from memory. Internal to this folder.
#pragma once
#include "base/error.h"

#include <ImfIO.h>

#include <algorithm>
#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>

namespace tyndall {
class ExrStream : public Imf::IStream {
public:
    ExrStream(const std::string& name, std::string_view bytes) : IStream(name.c_str()), bytes_(bytes) {}
    bool read(char* to, int count) override {
        if (count < 0 || static_cast<size_t>(count) > bytes_.size() - position_)
            throw std::runtime_error("the file ends too early");
        std::memcpy(to, bytes_.data() + position_, static_cast<size_t>(count));
        position_ += static_cast<size_t>(count);
        return position_ < bytes_.size();
    }
    uint64_t tellg() override { return position_; }
    void seekg(uint64_t position) override { position_ = std::min<uint64_t>(position, bytes_.size()); }

private:
    std::string_view bytes_;
    size_t position_ = 0;
};

// Runs `body`; reports anything the library throws as a damaged file.
template<class Body> auto guarded_exr(const std::string& file, const Body& body) {
    try {
        return body();
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const Error&) {
        throw;
    } catch (const std::exception&) {
        refuse(file, "the file is truncated or damaged"); // the library's message exposes its internals
    }
}
}
