// SPDX-License-Identifier: Apache-2.0
// The few calls that differ between Embree 3 and Embree 4, under one name.
#pragma once
#if __has_include(<embree4/rtcore.h>) && !__has_include(<embree3/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#if RTC_VERSION_MAJOR >= 4

typedef struct RTCRayQueryContext ty_embree_context;
#define TY_EMBREE_FILTER_FLAG RTC_SCENE_FLAG_FILTER_FUNCTION_IN_ARGUMENTS

static inline void ty_embree_context_init(ty_embree_context* context)
{
    rtcInitRayQueryContext(context);
}

static inline void ty_embree_intersect(RTCScene scene, ty_embree_context* context, RTCFilterFunctionN filter,
                                       struct RTCRayHit* ray_hit)
{
    struct RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    arguments.context = context;
    arguments.filter = filter;
    if (filter)
        arguments.flags = RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER;
    rtcIntersect1(scene, ray_hit, &arguments);
}

static inline void ty_embree_occluded(RTCScene scene, ty_embree_context* context, RTCFilterFunctionN filter,
                                      struct RTCRay* ray)
{
    struct RTCOccludedArguments arguments;
    rtcInitOccludedArguments(&arguments);
    arguments.context = context;
    arguments.filter = filter;
    if (filter)
        arguments.flags = RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER;
    rtcOccluded1(scene, ray, &arguments);
}

#else

typedef struct RTCIntersectContext ty_embree_context;
#define TY_EMBREE_FILTER_FLAG RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION

static inline void ty_embree_context_init(ty_embree_context* context)
{
    rtcInitIntersectContext(context);
}

static inline void ty_embree_intersect(RTCScene scene, ty_embree_context* context, RTCFilterFunctionN filter,
                                       struct RTCRayHit* ray_hit)
{
    context->filter = filter;
    rtcIntersect1(scene, context, ray_hit);
}

static inline void ty_embree_occluded(RTCScene scene, ty_embree_context* context, RTCFilterFunctionN filter,
                                      struct RTCRay* ray)
{
    context->filter = filter;
    rtcOccluded1(scene, context, ray);
}

#endif
