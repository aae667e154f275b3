#include "trace/frame_cache.h"

#include "base/io/file.h"
#include "scene/light.h"
#include "scene/lights/area_shape.h"
#include "trace/occlusion/occluders.h"
#include "trace/snapshot.h"
#include "trace/view.h"
#include "volume/bricks/bricks.h"

#include <algorithm>

namespace tyndall {
namespace {
bool same(const std::weak_ptr<const void>& a, const std::weak_ptr<const void>& b) {
    return !a.owner_before(b) && !b.owner_before(a);
}

std::shared_ptr<FrameCacheEntry> found(FrameCache* kept, std::type_index type, const CacheKey& key) {
    if (!kept) return nullptr;
    const std::scoped_lock lock(kept->mutex);
    for (const std::shared_ptr<FrameCacheEntry>& thing : kept->entries)
        if (thing->type == type && thing->key == key) return thing;
    return nullptr;
}
}

std::string content_of(const BrickPool& bricks) { return bricks.content; }
std::string content_of(const Occluders& occluders) { return occluders.content(); }

CacheKey& CacheKey::add(const Light& light) {
    add(light.kind).add(light.position).add(light.direction).add(light.inner_cone).add(light.outer_cone);
    if (const AreaShape* face = light.area.get())
        add(face->kind).add(face->center).add(face->right).add(face->up).add(face->half).add(face->two_sided);
    return add(light.range).add(light.radius).add(light.core).add(light.angle).add(light.shadows);
}

CacheKey& CacheKey::add(const View& view) {
    const Camera& camera = view.camera;
    add(camera.position).add(camera.right).add(camera.up).add(camera.forward).add(camera.vertical_fov);
    add(camera.ortho_height).add(camera.near).add(camera.far);
    if (const Lens& lens = camera.lens) add(lens.radius).add(lens.focus).add(lens.blades).add(lens.rotation);
    return add(view.size).add(view.filter).add(view.filter_radius);
}

bool CacheKey::operator==(const CacheKey& other) const {
    return bits == other.bits && std::ranges::equal(objects, other.objects, same);
}

CacheFolder* cache_folder(const Snapshot& snapshot) { return snapshot.files.get(); }

std::string content_of(const CacheKey& key, const CacheFolder& folder) {
    std::string text = "plan " + folder.plan + "\n" + content_hash(key.bits) + "\n";
    for (size_t i = 0; i < key.objects.size(); ++i) {
        const std::shared_ptr<const void> object = key.objects[i].lock();
        const std::string content = object ? key.contents[i](object.get()) : "none";
        if (content.empty()) return {};
        text += content + "\n";
    }
    return text;
}

std::shared_ptr<FrameCacheEntry> find_cached(const Snapshot& snapshot, std::type_index type, CacheKey key) {
    FrameCache *own = snapshot.cache.get(), *before = snapshot.previous_cache.get();
    std::shared_ptr<FrameCacheEntry> thing = found(before, type, key);
    if (!own && thing) return thing;
    if (!thing) thing.reset(new FrameCacheEntry{type, std::move(key), {}, nullptr});
    if (!own) return thing;

    // Another thread may have added it first.
    const std::scoped_lock lock(own->mutex);
    for (const std::shared_ptr<FrameCacheEntry>& known : own->entries)
        if (known->type == type && known->key == thing->key) return known;
    own->entries.push_back(thing);
    return thing;
}
}
