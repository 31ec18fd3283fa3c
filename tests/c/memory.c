/*
 * Prints what a solve takes: workspace and elements, which the caller brings, and the deepest stack, by painting the
 * stack of a thread and looking how much of the paint is left.
 */
#define _GNU_SOURCE
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "minvar.h"

#define STACK (1024 * 1024)
#define PAINT 0xa5

typedef struct {
    const minvar_curve *curve;
    const minvar_options *options;
    double *workspace;
    size_t workspace_len;
    minvar_element *elements;
    size_t elements_len;
    minvar_report report;
    minvar_code code;
} job;

static void *idle(void *unused) { return unused; }

static void *solve(void *data) {
    job *j = data;
    j->code = minvar_curve_solve(j->curve, j->options, j->workspace, j->workspace_len, NULL, NULL, j->elements,
                                 j->elements_len, NULL, 0, &j->report, NULL);
    return NULL;
}

static size_t stack_of(void *(*run)(void *), void *data) {
    unsigned char *stack = aligned_alloc(4096, STACK);
    if (stack == NULL) exit(1);
    memset(stack, PAINT, STACK);
    pthread_attr_t attributes;
    pthread_t thread;
    pthread_attr_init(&attributes);
    if (pthread_attr_setstack(&attributes, stack, STACK) != 0 ||
        pthread_create(&thread, &attributes, run, data) != 0)
        exit(1);
    pthread_join(thread, NULL);
    size_t clean = 0;
    while (clean < STACK && stack[clean] == PAINT) clean++;
    free(stack);
    return STACK - clean;
}

static void report(const char *name, const minvar_joint *joints, size_t count, unsigned per_span) {
    const minvar_curve curve = minvar_curve_through(joints, count, 0);
    minvar_options options = minvar_options_defaults();
    options.elements_per_span = per_span;
    job j = {.curve = &curve, .options = &options};
    if (minvar_curve_workspace_len(&curve, &options, &j.workspace_len, NULL) != MINVAR_OK) exit(1);
    j.elements_len = minvar_curve_elements_len(&curve, &options);
    j.workspace = malloc(j.workspace_len * sizeof(double));
    j.elements = malloc(j.elements_len * sizeof(minvar_element));
    const size_t used = stack_of(solve, &j) - stack_of(idle, NULL);
    if (j.code != MINVAR_OK || j.report.status != MINVAR_CONVERGED) exit(1);
    printf("%-34s %9zu %9zu %9zu %9zu\n", name, j.report.unknowns, j.workspace_len * sizeof(double),
           j.elements_len * sizeof(minvar_element), used);
    free(j.workspace);
    free(j.elements);
}

int main(void) {
    minvar_joint coving[2] = {minvar_joint_at(0.5, -12, 0), minvar_joint_at(20, -0.5, 0)};
    coving[0] = minvar_joint_with_tangent(coving[0], MINVAR_FIXED, 0, 1, 0);
    coving[0] = minvar_joint_with_curvature(coving[0], MINVAR_FIXED, 0.27, 0, 0);
    coving[1] = minvar_joint_with_tangent(coving[1], MINVAR_FIXED, 1, 0, 0);
    const double points[7][2] = {{0, 0}, {1, 1.9}, {2, 2.7}, {3, 2.6}, {4, 1.6}, {5, 0.89}, {6, 1.2}};
    minvar_joint woodford[7], space[7];
    for (int i = 0; i < 7; i++) {
        woodford[i] = minvar_joint_at(points[i][0], points[i][1], 0);
        space[i] = minvar_joint_at(points[i][0], points[i][1], 0.3 * i * i);
    }
    printf("%-34s %9s %9s %9s %9s\n", "bytes of", "unknowns", "workspace", "elements", "stack");
    report("2 joints, planar (coving)", coving, 2, 1);
    report("2 joints, planar, 8 elements", coving, 2, 8);
    report("7 joints, planar (Woodford)", woodford, 7, 1);
    report("7 joints, space", space, 7, 1);
    return 0;
}
