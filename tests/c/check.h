/* What the C tests share: checks that say where they failed, and outputs that must stay as they were. */
#ifndef CHECK_H
#define CHECK_H

#include "minvar.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static int failures;

#define CHECK(condition) \
    ((condition) ? (void)0 : (void)(failures++, printf("%s:%d: not true: %s\n", __FILE__, __LINE__, #condition)))

/* Relative difference. */
#define NEAR(a, b, within) \
    (fabs((a) - (b)) <= (within) * fabs(b) \
         ? (void)0 \
         : (void)(failures++, \
                  printf("%s:%d: %s = %.17g is not %.17g\n", __FILE__, __LINE__, #a, (double)(a), (double)(b))))

/* A call that must have worked. */
#define WORKS(call) \
    do { \
        minvar_error error_; \
        minvar_error *const e = &error_; \
        const minvar_code code_ = (call); \
        if (code_ != MINVAR_OK || error_.code != MINVAR_OK) { \
            failures++; \
            printf("%s:%d: %s: code %d: %s\n", __FILE__, __LINE__, #call, (int)code_, error_.message); \
        } \
    } while (0)

/* The coving of thesis section 4.11.5: from the wall, straight up, to the ceiling. */
static inline void coving(minvar_joint joints[2]) {
    joints[0] = minvar_joint_at(0.5, -12.0, 0.0);
    joints[0] = minvar_joint_with_tangent(joints[0], MINVAR_FIXED, 0.0, 1.0, 0.0);
    joints[0] = minvar_joint_with_curvature(joints[0], MINVAR_FIXED, 0.27, 0.0, 0.0);
    joints[1] = minvar_joint_at(20.0, -0.5, 0.0);
    joints[1] = minvar_joint_with_tangent(joints[1], MINVAR_FIXED, 1.0, 0.0, 0.0);
}

/* The exit status of a test. */
static inline int verdict(void) {
    printf(failures == 0 ? "all is well\n" : "%d checks failed\n", failures);
    return failures == 0 ? 0 : 1;
}

#endif
