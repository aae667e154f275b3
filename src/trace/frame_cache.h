// Cache of what one frame builds and the next may reuse, valid while its inputs do not change.
//
// Entries are found by a key of all their inputs, compared bitwise and by object identity, so that a cached entry is
// bit-identical to a rebuilt one. A snapshot holds the entries of its own frame and of the previous one; an entry that
// two consecutive frames do not request is dropped.
//
// With a prepared plan, entries come from files (base/io/cache_folder.h) if their fields can be serialized and their
// key identifies their inputs in every process.
#pragma once
#include "base/io/cache_folder.h"
#include "base/math.h"

#include <memory>
#include <mutex>
#include <string>
#include <type_traits>
#include <typeindex>
#include <vector>

namespace tyndall {
struct BrickPool;
struct Light;
class Occluders;
struct Snapshot;
struct View;

// Describes what an object is made from: for one plan the same text in every process; empty = unknown.
std::string content_of(const BrickPool& bricks);
std::string content_of(const Occluders& occluders);

struct CacheKey {
    using ContentOf = std::string (*)(const void*);
    std::string bits;                               // plain values, concatenated
    std::vector<std::weak_ptr<const void>> objects; // compared by owner, even once they are gone
    std::vector<ContentOf> contents;                // gives the content of each while it exists

    template<class T>
    requires std::is_arithmetic_v<T> || std::is_enum_v<T> CacheKey& add(T value) {
        bits.append(reinterpret_cast<const char*>(&value), sizeof value);
        return *this;
    }
    template<glm::length_t n, class T> CacheKey& add(const glm::vec<n, T>& v) {
        for (glm::length_t i = 0; i < n; ++i) add(v[i]);
        return *this;
    }
    template<class T> CacheKey& add(const std::shared_ptr<T>& object) {
        objects.emplace_back(object);
        contents.push_back([](const void* at) {
            if constexpr (requires(const T& thing) { content_of(thing); })
                return content_of(*static_cast<const T*>(at));
            else
                return std::string();
        });
        return *this;
    }
    CacheKey& add(const Box& box) { return add(box.low).add(box.high); }
    CacheKey& add(const Light& light); // its position and shape, not its brightness
    CacheKey& add(const View& view);   // everything its rays depend on

    bool operator==(const CacheKey& other) const;
};

struct FrameCacheEntry {
    std::type_index type;
    CacheKey key;
    std::once_flag made;
    std::shared_ptr<const void> value;
};

// Entries of one frame.
struct FrameCache {
    std::mutex mutex;
    std::vector<std::shared_ptr<FrameCacheEntry>> entries;
};

// The entry with this type and key in the snapshot's frame or the previous one, or a new empty one. Thread-safe.
std::shared_ptr<FrameCacheEntry> find_cached(const Snapshot& snapshot, std::type_index type, CacheKey key);

// The folder of the snapshot's plan, null if there is none; and a key as text that is the same in every process, empty
// if the content of an object is unknown.
CacheFolder* cache_folder(const Snapshot& snapshot);
std::string content_of(const CacheKey& key, const CacheFolder& folder);

// The result of make() for this key, cached in the snapshot's frame or the previous one; calls make() if there is none.
// Snapshots made by hand cache nothing. `what` names the entry in messages and files.
template<class Make> auto cached(const Snapshot& snapshot, const char* what, CacheKey key, const Make& make) {
    using T = decltype(make());
    const std::shared_ptr<FrameCacheEntry> thing = find_cached(snapshot, typeid(T), std::move(key));
    std::call_once(thing->made, [&] {
        CacheFolder* folder = cache_folder(snapshot);
        const std::string content = folder ? content_of(thing->key, *folder) : std::string();
        thing->value = std::make_shared<const T>(load_or_build<T>(folder, what, content, make));
    });
    return std::static_pointer_cast<const T>(thing->value);
}
}
