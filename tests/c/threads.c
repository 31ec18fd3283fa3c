/* Threads that solve at once, each in its own memory and all from the same joints, get the bits that one gets alone. */
#include "check.h"

#include <pthread.h>
#include <stdlib.h>

enum { THREADS = 2, ROUNDS = 10, JOINTS = 7, PER_SPAN = 4, ELEMENTS = (JOINTS - 1) * PER_SPAN };

static minvar_joint joints[JOINTS];
static const minvar_curve curve = {.joints = joints, .joint_count = JOINTS};
static minvar_options options;

typedef struct {
    minvar_element elements[ELEMENTS];
    minvar_report report;
    minvar_figures figures;
    double *workspace;
    size_t workspace_len;
    pthread_barrier_t *start;
} job;

static minvar_code run(job *j) {
    const minvar_code code = minvar_curve_solve(&curve, &options, j->workspace, j->workspace_len, NULL, NULL, j->elements,
                                                ELEMENTS, NULL, 0, &j->report, NULL);
    return code != MINVAR_OK ? code : minvar_measure(j->elements, ELEMENTS, &j->figures, NULL);
}

static job alone, at_once[THREADS];

static void *work(void *context) {
    job *j = context;
    pthread_barrier_wait(j->start);
    for (int i = 0; i < ROUNDS; i++) {
        if (run(j) != MINVAR_OK || memcmp(j->elements, alone.elements, sizeof j->elements) != 0 ||
            memcmp(&j->report, &alone.report, sizeof j->report) != 0 ||
            memcmp(&j->figures, &alone.figures, sizeof j->figures) != 0) {
            return context;
        }
    }
    return NULL;
}

int main(void) {
    /* Nearly a turn of a helix. */
    static const double points[JOINTS][3] = {{1, 0, 0},    {0.5, 0.9, 0.4}, {-0.5, 0.8, 0.9}, {-1, 0.1, 1.1},
                                             {-0.5, -0.9, 1.6}, {0.6, -0.8, 2}, {1.1, 0, 2.5}};
    for (int i = 0; i < JOINTS; i++) {
        joints[i] = minvar_joint_at(points[i][0], points[i][1], points[i][2]);
    }
    options = minvar_options_defaults();
    options.elements_per_span = PER_SPAN;
    size_t workspace_len = 0;
    WORKS(minvar_curve_workspace_len(&curve, &options, &workspace_len, e));

    alone.workspace = malloc(workspace_len * sizeof(double));
    alone.workspace_len = workspace_len;
    CHECK(run(&alone) == MINVAR_OK);
    printf("%s; %zu iterations\n", minvar_status_sentence(alone.report.status), alone.report.iterations);
    CHECK(alone.report.status == MINVAR_CONVERGED && alone.report.planar == 0);

    pthread_barrier_t start;
    pthread_barrier_init(&start, NULL, THREADS);
    pthread_t threads[THREADS];
    for (int i = 0; i < THREADS; i++) {
        at_once[i].workspace = malloc(workspace_len * sizeof(double));
        at_once[i].workspace_len = workspace_len;
        at_once[i].start = &start;
        CHECK(pthread_create(&threads[i], NULL, work, &at_once[i]) == 0);
    }
    for (int i = 0; i < THREADS; i++) {
        void *wrong = NULL;
        pthread_join(threads[i], &wrong);
        CHECK(wrong == NULL);
        free(at_once[i].workspace);
    }
    pthread_barrier_destroy(&start);
    free(alone.workspace);
    return verdict();
}
