// The push constants and parameters of the course's kernels. Include it first: it adds the round to the pass.
#ifndef GLIM_ACCESS_COURSE_ROUND
#define GLIM_ACCESS_COURSE_ROUND

#if defined(GLIM_ACCESS_PASS)
#error "access/course/round.glsl must come before access/pass.glsl"
#endif
#define PUSH_CONSTANTS Pass pass; CourseRound lightRound;
#include "access/course/features.glsl"
#include "access/pass.glsl"

layout(set = 0, binding = kBindCourseParameters, scalar) readonly buffer CourseParametersBlock { CourseParameters courseParameters; };

// As `render` (access/parameters.glsl).
CourseParameters course = courseParameters;

#endif
