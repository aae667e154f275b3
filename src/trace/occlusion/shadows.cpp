// Structures for exact shadows: they depend only on the triangles, and are shared along with them.
#include "trace/occlusion/scene.h"
#include "trace/shadows/intervals/shadow_slices.h"
#include "trace/shadows/volumes/shadow_mesh.h"

namespace tyndall {
const ShadowSlices& Occluders::shadow_slices() const {
    std::call_once(impl_->sliced, [&] {
        impl_->slices = std::make_shared<const ShadowSlices>(make_shadow_slices(shadow_triangles()));
    });
    return *impl_->slices;
}

std::shared_ptr<const ShadowMesh> Occluders::shadow_mesh() const {
    std::call_once(impl_->meshed,
                   [&] { impl_->mesh = std::make_shared<const ShadowMesh>(make_shadow_mesh(shadow_triangles())); });
    return impl_->mesh;
}
}
