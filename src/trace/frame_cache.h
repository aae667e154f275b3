// What one frame makes and the next may need again: kept for as long as what it depends on stands still.
//
// Things are found by a key of everything they depend on, compared bit by bit and object by object, so that a thing
// that is found has the bits it would have if it were made. A snapshot knows what its own frame made or found and what
// the frame before it did; what two frames in a row did not ask for is gone.
//
// Of a plan that was prepared, things come from files (base/io/cache_folder.h): those whose fields can be written, and
// whose key says in every process what they depend on.
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

// What an object is made from, for the same plan the same text in every process; empty = not known.
std::string content_of(const BrickPool& bricks);
std::string content_of(const Occluders& occluders);

struct CacheKey {
    using ContentOf = std::string (*)(const void*);
    std::string bits;                               // of plain values, one after the other
    std::vector<std::weak_ptr<const void>> objects; // they need not live on: none is ever taken for another
    std::vector<ContentOf> contents;                // of each, while it lives

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
    CacheKey& add(const Light& light); // its place and shape; how bright it is does not count
    CacheKey& add(const View& view);   // the rays it may send

    bool operator==(const CacheKey& other) const;
};

struct CachedThing {
    std::type_index type;
    CacheKey key;
    std::once_flag made;
    std::shared_ptr<const void> value;
};

// Of one frame.
struct FrameCache {
    std::mutex mutex;
    std::vector<std::shared_ptr<CachedThing>> things;
};

// The thing of a type and key in the snapshot's frame or in the one before, or a new empty one. From any thread.
std::shared_ptr<CachedThing> find_cached(const Snapshot& snapshot, std::type_index type, CacheKey key);

// The folder of the snapshot's plan, null where there is none; and what a key says in every process, empty where an
// object does not tell.
CacheFolder* cache_folder(const Snapshot& snapshot);
std::string content_of(const CacheKey& key, const CacheFolder& folder);

// What make() returned the first time that the snapshot's frame, or the one before, asked for it with this key. A
// snapshot made by hand keeps nothing. `what` names the thing to people.
template<class Make> auto cached(const Snapshot& snapshot, const char* what, CacheKey key, const Make& make) {
    using T = decltype(make());
    const std::shared_ptr<CachedThing> thing = find_cached(snapshot, typeid(T), std::move(key));
    std::call_once(thing->made, [&] {
        CacheFolder* folder = cache_folder(snapshot);
        const std::string content = folder ? content_of(thing->key, *folder) : std::string();
        thing->value = std::make_shared<const T>(found_or_made<T>(folder, what, content, make));
    });
    return std::static_pointer_cast<const T>(thing->value);
}
}
