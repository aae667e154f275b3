#include "scene/lights/area_shape.h"

#include "scene/lights/gobo.h"
#include "scene/lights/light_filter.h"
#include "scene/lights/spherical_rectangle.h"
#include "scene/photometry/ies_file.h"
#include "scene/photometry/ies_profile.h"

namespace tyndall {
namespace {
bool is_ball(const AreaShape& shape) { return shape.kind == LightKind::sphere; }

// Lambert's cosine to the front or to both sides, as an IES profile.
std::shared_ptr<const IesProfile> cosine_profile(bool both_sides) {
    IesFile file;
    file.horizontal = {0};
    const int last = both_sides ? 180 : 90;
    for (int angle = 0; angle <= last; ++angle) {
        file.vertical.push_back(angle);
        file.candela.push_back(angle == 90 ? 0 : std::abs(std::cos(glm::radians(double(angle)))));
    }
    return make_ies_profile(file, both_sides ? "cosine to both sides" : "cosine");
}

// Whether the point is on an emitting side.
bool is_before(const AreaShape& shape, vec3 point) {
    if (is_ball(shape)) return glm::distance(point, shape.center) > shape.half.x;
    const float height = glm::dot(point - shape.center, shape.normal);
    return shape.two_sided ? height != 0 : height > 0;
}

constexpr double small = 1e-6; // steradians, below which doubles do not resolve the angles of a rectangle
constexpr float near = 3;      // radii of a disc within which it is sampled through its bounding square

bool is_near_disc(const AreaShape& shape, vec3 point) {
    return shape.kind == LightKind::disc && glm::distance(point, shape.center) <= near * shape.half.x;
}

SphericalRectangle seen_from(const AreaShape& shape, vec3 point) {
    return {shape.center, shape.right, shape.up, glm::dvec2(shape.half), point};
}

double ball_steradians(const AreaShape& shape, vec3 point) {
    const double distance = glm::distance(dvec3(point), dvec3(shape.center)), sine = shape.half.x / distance;
    return 2 * double{pi} * sine * sine / (1 + std::sqrt(std::max(0.0, 1 - sine * sine)));
}

AreaSample sample_ball(const AreaShape& shape, vec3 point, vec2 u) {
    Light ball;
    ball.position = shape.center, ball.radius = shape.half.x;
    const Ray ray = ray_to_light(ball, point, u);
    return {ray.direction, ray.t_max, static_cast<float>(ball_steradians(shape, point))};
}

// 1 / pdf over solid angle when points of the face are sampled uniformly by area.
float steradians_by_area(const AreaShape& shape, vec3 direction, float distance) {
    return face_area(shape) * std::abs(glm::dot(direction, shape.normal)) / (distance * distance);
}

AreaSample towards(const AreaShape& shape, vec3 point, vec2 place) {
    const vec3 offset = shape.center + place.x * shape.right + place.y * shape.up - point;
    const float distance = glm::length(offset);
    return {offset / distance, distance, steradians_by_area(shape, offset / distance, distance)};
}

// Samples a point of the rectangle, or of the bounding square of a disc.
AreaSample sample_rectangle(const AreaShape& shape, vec3 point, vec2 u) {
    const SphericalRectangle seen = seen_from(shape, point);
    const glm::dvec2 place =
        seen.steradians > small ? seen.place(u) : (2.0 * glm::dvec2(u) - 1.0) * glm::dvec2(shape.half);
    AreaSample sample = towards(shape, point, vec2(place));
    if (seen.steradians > small) sample.steradians = static_cast<float>(seen.steradians);
    return sample;
}

AreaSample sample_disc(const AreaShape& shape, vec3 point, vec2 u) {
    if (!is_near_disc(shape, point)) {
        const float radius = shape.half.x * std::sqrt(u.x), turn = 2 * pi * u.y;
        return towards(shape, point, radius * vec2(std::cos(turn), std::sin(turn)));
    }
    AreaSample sample = sample_rectangle(shape, point, u);
    const vec3 off = point + sample.direction * sample.distance - shape.center;
    if (glm::dot(off, off) > shape.half.x * shape.half.x) sample.steradians = 0;
    return sample;
}

// Moments of a texture's light; positions in units of the half-extents along right and up.
struct TextureSums {
    dvec3 mean{0};
    glm::dvec2 middle{0}, square{0}; // centroid and second moment of luminance
};

TextureSums sums_of(const Gobo& texture) {
    const Gobo::Level& level = texture.levels[0];
    const size_t plane = static_cast<size_t>(level.size.x) * level.size.y;
    TextureSums sums;
    for (int y = 1; y < level.size.y - 1; ++y)
        for (int x = 1; x < level.size.x - 1; ++x) {
            const float* texel = level.values.data() + static_cast<size_t>(y) * level.size.x + x;
            const dvec3 color = texture.planes == 3 ? dvec3(texel[0], texel[plane], texel[2 * plane]) : dvec3(*texel);
            const glm::dvec2 at = 1.0 - 2.0 * (glm::dvec2(x, y) - 0.5) / glm::dvec2(level.texels);
            const double light = luminance(vec3(color));
            sums.mean += color, sums.middle += light * at, sums.square += light * at * at;
        }
    const double texels = double{level.texels.x} * level.texels.y, light = luminance(vec3(sums.mean));
    if (light > 0) sums.middle /= light, sums.square /= light;
    sums.mean /= texels;
    return sums;
}

// Moves the light to the centroid of the texture's luminance and scales it by the texture's mean.
void apply_texture(AreaShape& shape, Light& light) {
    const TextureSums sums = sums_of(*shape.texture);
    for (int c = 0; c < 3; ++c) {
        shape.texture_scale[c] = sums.mean[c] > 0 ? static_cast<float>(1 / sums.mean[c]) : 0;
        light.intensity[c] *= static_cast<float>(sums.mean[c]);
    }
    const vec2 middle = vec2(sums.middle) * shape.half;
    light.position = shape.center + middle.x * shape.right + middle.y * shape.up;
    shape.spread = vec2(3.0 * (sums.square - sums.middle * sums.middle));
}

// Relative error of a lamp's light at an offset from the center, in axes right, up and normal. Discs and
// textured faces count as the rectangle whose emission varies as much in position.
double lamp_error(const AreaShape& shape, dvec3 offset) {
    const double distance = glm::length(offset), square = 1 / (distance * distance);
    if (is_ball(shape)) {
        if (distance <= shape.half.x) return infinity;
        return face_area(shape) * square / ball_steradians(shape, shape.center + vec3(float(distance), 0, 0)) - 1;
    }
    const glm::dvec2 spread = glm::max(glm::dvec2(shape.spread), 1e-4) * (shape.kind == LightKind::disc ? 0.75 : 1.0);
    const glm::dvec2 half = glm::dvec2(shape.half) * glm::sqrt(spread);
    const SphericalRectangle seen(dvec3(0), {1, 0, 0}, {0, 1, 0}, half, offset);
    return 4 * half.x * half.y * offset.z / distance * square / seen.steradians - 1;
}
}

float face_area(const AreaShape& shape) {
    return shape.kind == LightKind::rectangle ? 4 * shape.half.x * shape.half.y : pi * shape.half.x * shape.half.x;
}

void make_punctual(const AreaShape& shape, Light& light) {
    static const std::shared_ptr<const IesProfile> ahead = cosine_profile(false), both = cosine_profile(true);
    auto face = std::make_shared<AreaShape>(shape);
    if (face->texture) apply_texture(*face, light);
    light.area = std::move(face);
    light.kind = LightKind::point, light.radius = std::sqrt(face_area(shape) / pi);
    if (!(light.radius > 0)) light.intensity = vec3(0);
    if (is_ball(shape)) return;
    auto filter = std::make_shared<LightFilter>();
    filter->direction = light.direction = shape.normal;
    filter->profile = shape.two_sided ? both : ahead;
    filter->profile_axes = filter->gobo_axes = {shape.right, shape.up};
    light.filter = std::move(filter);
    if (!shape.two_sided) light.kind = LightKind::spot, light.inner_cone = light.outer_cone = ahead->reach;
}

vec3 radiance_of(const Light& light) { return light.intensity / face_area(*light.area); }

vec3 face_texture(const AreaShape& shape, vec3 at) {
    if (!shape.texture) return vec3(1);
    const vec3 off = at - shape.center;
    const vec2 place = 0.5f - 0.5f * vec2(glm::dot(off, shape.right), glm::dot(off, shape.up)) / shape.half;
    const vec2 edge = 0.5f / shape.texture->levels[0].texels; // the outermost texels extend to the edge
    const vec2 inside = glm::clamp(place, edge, 1.0f - edge);
    return shape.texture_scale * vec3(gobo_at(*shape.texture, inside.x, inside.y));
}

AreaSample sample_area(const AreaShape& shape, vec3 point, vec2 u) {
    if (!is_before(shape, point)) return {};
    if (is_ball(shape)) return sample_ball(shape, point, u);
    return shape.kind == LightKind::disc ? sample_disc(shape, point, u) : sample_rectangle(shape, point, u);
}

float area_steradians(const AreaShape& shape, vec3 point, vec3 direction, float distance) {
    if (is_ball(shape)) return static_cast<float>(ball_steradians(shape, point));
    if (shape.kind == LightKind::rectangle || is_near_disc(shape, point))
        if (const double seen = seen_from(shape, point).steradians; seen > small) return static_cast<float>(seen);
    return steradians_by_area(shape, direction, distance);
}

float area_hit(const AreaShape& shape, const Ray& ray) {
    if (!is_before(shape, ray.origin)) return infinity;
    const vec3 offset = shape.center - ray.origin;
    if (is_ball(shape)) {
        const float along = glm::dot(offset, ray.direction);
        const vec3 off = offset - along * ray.direction;
        const float rest = shape.half.x * shape.half.x - glm::dot(off, off);
        return along > 0 && rest > 0 ? along - std::sqrt(rest) : infinity;
    }
    const float t = glm::dot(offset, shape.normal) / glm::dot(ray.direction, shape.normal);
    if (!(t > 0) || !std::isfinite(t)) return infinity;
    const vec3 off = ray.at(t) - shape.center;
    const vec2 place = glm::abs(vec2(glm::dot(off, shape.right), glm::dot(off, shape.up)));
    const bool inside = shape.kind == LightKind::disc ? glm::dot(place, place) < shape.half.x * shape.half.x
                                                      : place.x < shape.half.x && place.y < shape.half.y;
    return inside ? t : infinity;
}

vec3 rough_irradiance(const Light& light, vec3 point) {
    const AreaShape& shape = *light.area;
    if (!is_before(shape, point)) return vec3(0);
    const vec3 offset = point - shape.center;
    const float reach = is_ball(shape) ? shape.half.x : glm::length(shape.half);
    const float distance = std::max(glm::length(offset), reach);
    const float height = is_ball(shape) ? distance : std::abs(glm::dot(offset, shape.normal));
    return light.intensity * (std::min((height + reach) / distance, 1.0f) / (distance * distance));
}

double far_distance(const AreaShape& shape, double share) {
    const double size = std::sqrt(face_area(shape) / pi);
    double farthest = size;
    for (const double slant : {0.0, 30.0, 60.0, 70.0, 80.0})
        for (const double turn : {0.0, 45.0, 90.0}) {
            const double polar = glm::radians(slant), around = glm::radians(turn);
            const dvec3 direction(std::sin(polar) * std::cos(around), std::sin(polar) * std::sin(around),
                                  std::cos(polar));
            double low = size, high = 1e4 * size;
            for (int i = 0; i < 20; ++i) {
                const double middle = std::sqrt(low * high);
                (std::abs(lamp_error(shape, middle * direction)) > share ? low : high) = middle;
            }
            farthest = std::max(farthest, high);
        }
    return farthest;
}
}
