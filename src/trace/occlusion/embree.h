// Embree 3 and 4 behind one interface. A query's flags are part of its context in 3, and separate from it in 4.
#pragma once
#if TYNDALL_EMBREE >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace tyndall {
#if TYNDALL_EMBREE >= 4
using QueryContext = RTCRayQueryContext;
using QueryFlags = RTCRayQueryFlags;
inline constexpr QueryFlags coherent_query = RTC_RAY_QUERY_FLAG_COHERENT,
                            incoherent_query = RTC_RAY_QUERY_FLAG_INCOHERENT;

inline RTCIntersectArguments intersect_arguments(QueryContext& context, QueryFlags flags) {
    rtcInitRayQueryContext(&context);
    RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    arguments.flags = flags, arguments.context = &context;
    return arguments;
}
inline RTCOccludedArguments occluded_arguments(QueryContext& context, QueryFlags flags) {
    rtcInitRayQueryContext(&context);
    RTCOccludedArguments arguments;
    rtcInitOccludedArguments(&arguments);
    arguments.flags = flags, arguments.context = &context;
    return arguments;
}

inline void intersect(RTCScene scene, const int* valid, QueryContext& context, QueryFlags flags, RTCRayHit8& packet) {
    RTCIntersectArguments arguments = intersect_arguments(context, flags);
    rtcIntersect8(valid, scene, &packet, &arguments);
}
inline void intersect(RTCScene scene, const int* valid, QueryContext& context, QueryFlags flags, RTCRayHit16& packet) {
    RTCIntersectArguments arguments = intersect_arguments(context, flags);
    rtcIntersect16(valid, scene, &packet, &arguments);
}
inline void occlude(RTCScene scene, const int* valid, QueryContext& context, QueryFlags flags, RTCRay8& packet) {
    RTCOccludedArguments arguments = occluded_arguments(context, flags);
    rtcOccluded8(valid, scene, &packet, &arguments);
}
inline void occlude(RTCScene scene, const int* valid, QueryContext& context, QueryFlags flags, RTCRay16& packet) {
    RTCOccludedArguments arguments = occluded_arguments(context, flags);
    rtcOccluded16(valid, scene, &packet, &arguments);
}
inline void occlude(RTCScene scene, QueryContext& context, QueryFlags flags, RTCRay& ray) {
    RTCOccludedArguments arguments = occluded_arguments(context, flags);
    rtcOccluded1(scene, &ray, &arguments);
}
#else
using QueryContext = RTCIntersectContext;
using QueryFlags = RTCIntersectContextFlags;
inline constexpr QueryFlags coherent_query = RTC_INTERSECT_CONTEXT_FLAG_COHERENT,
                            incoherent_query = RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;

inline QueryContext* started(QueryContext& context, QueryFlags flags) {
    rtcInitIntersectContext(&context);
    context.flags = flags;
    return &context;
}

inline void intersect(RTCScene scene, const int* valid, QueryContext& context, QueryFlags flags, RTCRayHit8& packet) {
    rtcIntersect8(valid, scene, started(context, flags), &packet);
}
inline void intersect(RTCScene scene, const int* valid, QueryContext& context, QueryFlags flags, RTCRayHit16& packet) {
    rtcIntersect16(valid, scene, started(context, flags), &packet);
}
inline void occlude(RTCScene scene, const int* valid, QueryContext& context, QueryFlags flags, RTCRay8& packet) {
    rtcOccluded8(valid, scene, started(context, flags), &packet);
}
inline void occlude(RTCScene scene, const int* valid, QueryContext& context, QueryFlags flags, RTCRay16& packet) {
    rtcOccluded16(valid, scene, started(context, flags), &packet);
}
inline void occlude(RTCScene scene, QueryContext& context, QueryFlags flags, RTCRay& ray) {
    rtcOccluded1(scene, started(context, flags), &ray);
}
#endif
}
