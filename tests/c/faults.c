/* Faults of the caller: memory one entry short or misaligned, exactly as long as asked for between pages that nobody
 * may touch, dirty, used again; an observer that stops at any iteration, wavers, answers garbage or writes into its
 * record. After each the outputs are untouched or whole, and the next call in the same memory gives the same bits. */
#ifndef _DEFAULT_SOURCE
#define _DEFAULT_SOURCE /* MAP_ANONYMOUS */
#endif
#include "check.h"

#include <limits.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <unistd.h>

enum { PATTERN = 0xA5, MOST_RECORDS = 300, MINIMA = 3, BEYOND = 2 };

typedef struct {
    const char *name;
    minvar_joint joints[7];
    size_t count;
    int32_t closed;
    minvar_obstacle obstacles[2];
    size_t obstacle_count;
    minvar_options options;
    int warm; /* starts from the last solution, before a joint moved */
} kind;

/* Memory of just this size: the page behind it and, but for what aligns it, the page before it are out of bounds. */
static void *guarded(size_t bytes) {
    const size_t page = (size_t)sysconf(_SC_PAGESIZE);
    const size_t pages = (bytes + page - 1) / page;
    unsigned char *all = mmap(NULL, (pages + 2) * page, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (all == MAP_FAILED || mprotect(all, page, PROT_NONE) != 0 ||
        mprotect(all + (pages + 1) * page, page, PROT_NONE) != 0) {
        printf("no memory for the test\n");
        exit(1);
    }
    return all + (pages + 1) * page - bytes;
}

static void release(void *memory, size_t bytes) {
    const size_t page = (size_t)sysconf(_SC_PAGESIZE);
    const size_t pages = (bytes + page - 1) / page;
    munmap((unsigned char *)memory + bytes - (pages + 1) * page, (pages + 2) * page);
}

typedef struct {
    double *workspace;
    size_t workspace_len;
    minvar_element *elements, *last; /* what was found, and what a warm start begins with */
    size_t elements_len;
    minvar_record records[MOST_RECORDS];
    minvar_report report;
    minvar_error error;
    minvar_code code;
} job;

/* ---- observers ---- */

typedef struct {
    size_t calls, stop_at;
    int32_t answer;
    int scribbles;
    const minvar_record *kept; /* kept, and looked at no more */
} watcher;

static int32_t watch(void *context, size_t iteration, const minvar_record *record) {
    watcher *w = context;
    w->calls++;
    CHECK(iteration == w->calls);
    w->kept = record;
    if (w->scribbles) {
        memset((void *)(uintptr_t)record, PATTERN, sizeof *record);
    }
    /* Once only: it would go on if it were asked again. */
    return w->calls == w->stop_at ? w->answer : 0;
}

/* ---- solving ---- */

static minvar_curve curve_of(const kind *k) {
    minvar_curve curve = minvar_curve_through(k->joints, k->count, k->closed);
    curve.obstacles = k->obstacle_count > 0 ? k->obstacles : NULL;
    curve.obstacle_count = k->obstacle_count;
    return curve;
}

static void solve(const kind *k, job *j, watcher *w) {
    const minvar_curve curve = curve_of(k);
    memset(j->elements, PATTERN, (j->elements_len + BEYOND) * sizeof *j->elements);
    memset(j->records, PATTERN, sizeof j->records);
    memset(&j->report, PATTERN, sizeof j->report);
    memset(&j->error, PATTERN, sizeof j->error);
    if (k->warm) {
        memcpy(j->elements, j->last, j->elements_len * sizeof *j->elements);
        j->code = minvar_curve_update(&curve, &k->options, j->workspace, j->workspace_len, w != NULL ? watch : NULL, w,
                                      j->elements, j->elements_len, &j->report, &j->error);
    } else {
        j->code = minvar_curve_solve(&curve, &k->options, j->workspace, j->workspace_len, w != NULL ? watch : NULL, w,
                                     j->elements, j->elements_len, j->records, MOST_RECORDS, &j->report, &j->error);
    }
}

static int untouched(const void *memory, size_t bytes) {
    const unsigned char *byte = memory;
    for (size_t i = 0; i < bytes; i++) {
        if (byte[i] != PATTERN) {
            return 0;
        }
    }
    return 1;
}

static int same_records(const job *a, const job *b, size_t count) {
    return memcmp(a->records, b->records, count * sizeof a->records[0]) == 0;
}

static int same(const job *a, const job *b) {
    return a->code == b->code && memcmp(&a->report, &b->report, sizeof a->report) == 0 &&
           memcmp(a->elements, b->elements, (a->elements_len + BEYOND) * sizeof *a->elements) == 0 &&
           same_records(a, b, MOST_RECORDS);
}

/* Whether the elements are a whole curve through what is fixed, and nothing is touched beyond. */
static int whole(const kind *k, const minvar_element *elements, size_t count, size_t room) {
    for (size_t i = 0; i < count; i++) {
        for (int row = 0; row < 6; row++) {
            for (int d = 0; d < 3; d++) {
                if (!isfinite(elements[i].rows[row][d])) {
                    return 0;
                }
            }
        }
        if (i + 1 < count && memcmp(elements[i].rows[5], elements[i + 1].rows[0], sizeof elements[i].rows[0]) != 0) {
            for (int d = 0; d < 3; d++) {
                if (fabs(elements[i].rows[5][d] - elements[i + 1].rows[0][d]) > 1e-11) {
                    return 0;
                }
            }
        }
    }
    for (size_t i = 0; i < k->count; i++) {
        int met = k->joints[i].position.given != MINVAR_FIXED;
        for (size_t e = 0; e < count && !met; e++) {
            met = memcmp(elements[e].rows[0], k->joints[i].position.value, sizeof(double[3])) == 0 ||
                  memcmp(elements[e].rows[5], k->joints[i].position.value, sizeof(double[3])) == 0;
        }
        if (!met) {
            return 0;
        }
    }
    return untouched(elements + count, (room - count) * sizeof *elements);
}

static job open_job(const kind *k) {
    job j;
    memset(&j, 0, sizeof j);
    const minvar_curve curve = curve_of(k);
    WORKS(minvar_curve_workspace_len(&curve, &k->options, &j.workspace_len, e));
    j.elements_len = minvar_curve_elements_len(&curve, &k->options);
    j.workspace = guarded(j.workspace_len * sizeof *j.workspace);
    memset(j.workspace, 0, j.workspace_len * sizeof *j.workspace);
    j.elements = guarded((j.elements_len + BEYOND) * sizeof *j.elements);
    j.last = guarded(j.elements_len * sizeof *j.last);
    if (k->warm) {
        kind before = *k;
        before.warm = 0;
        before.joints[1].position.value[1] -= 0.2;
        solve(&before, &j, NULL);
        CHECK(j.code == MINVAR_OK && j.report.elements == j.elements_len);
        memcpy(j.last, j.elements, j.elements_len * sizeof *j.last);
    }
    return j;
}

static void close_job(job *j) {
    release(j->workspace, j->workspace_len * sizeof *j->workspace);
    release(j->elements, (j->elements_len + BEYOND) * sizeof *j->elements);
    release(j->last, j->elements_len * sizeof *j->last);
}

static size_t cancelled;

static void cancel(const kind *k, job *j, const job *clean, size_t stop_at, int32_t answer) {
    watcher w = {.stop_at = stop_at, .answer = answer};
    solve(k, j, &w);
    const int failed_before = failures;
    CHECK(j->code == MINVAR_OK && j->error.code == MINVAR_OK);
    CHECK(j->report.status == MINVAR_CANCELLED);
    CHECK(w.calls == stop_at); /* who asked to stop is not asked again */
    CHECK(j->report.iterations == stop_at);
    CHECK(isfinite(j->report.value) && isfinite(j->report.length) && j->report.length > 0);
    CHECK(j->report.elements >= 1 && j->report.elements <= j->elements_len);
    CHECK(whole(k, j->elements, j->report.elements, j->elements_len + BEYOND));
    if (!k->warm) {
        CHECK(same_records(j, clean, stop_at));
        CHECK(untouched(j->records + stop_at, (MOST_RECORDS - stop_at) * sizeof j->records[0]));
    }
    if (failures > failed_before) {
        printf("    %s, cancelled at %zu of %zu with %ld\n", k->name, stop_at, clean->report.iterations, (long)answer);
    }
    cancelled++;
}

static void faults_of(const kind *k) {
    static job clean;
    clean = open_job(k);
    solve(k, &clean, NULL);
    if (clean.code != MINVAR_OK || clean.report.status != MINVAR_CONVERGED) {
        failures++;
        printf("%s: code %d, status %d\n", k->name, (int)clean.code, (int)clean.report.status);
    }
    CHECK(whole(k, clean.elements, clean.report.elements, clean.elements_len + BEYOND));

    static job j;
    j = open_job(k);
    /* Dirty: NaN, huge, tiny; then as the last solve left it. */
    static const unsigned char dirt[3] = {0xff, 0x7f, 0x01};
    for (int i = 0; i < 3; i++) {
        memset(j.workspace, dirt[i], j.workspace_len * sizeof *j.workspace);
        solve(k, &j, NULL);
        CHECK(same(&j, &clean));
    }
    solve(k, &j, NULL);
    CHECK(same(&j, &clean));

    /* One entry short. */
    j.workspace_len--;
    memset(j.workspace, PATTERN, j.workspace_len * sizeof *j.workspace);
    solve(k, &j, NULL);
    CHECK(j.code == MINVAR_WORKSPACE_TOO_SMALL && j.error.needed == j.workspace_len + 1);
    CHECK(j.error.given == j.workspace_len && untouched(j.workspace, j.workspace_len * sizeof *j.workspace));
    CHECK(untouched(&j.report, sizeof j.report) && untouched(j.records, sizeof j.records));
    CHECK(k->warm || untouched(j.elements, (j.elements_len + BEYOND) * sizeof *j.elements));
    CHECK(!k->warm || memcmp(j.elements, j.last, j.elements_len * sizeof *j.last) == 0);

    /* Aligned to less than a double. */
    double *const aligned = j.workspace;
    for (int by = 1; by < (int)sizeof(double); by++) {
        j.workspace = (double *)(void *)((unsigned char *)aligned + by);
        solve(k, &j, NULL);
        CHECK(j.code == MINVAR_MISALIGNED && strstr(j.error.message, "workspace") != NULL);
        CHECK(untouched(aligned, j.workspace_len * sizeof *j.workspace) && untouched(&j.report, sizeof j.report));
    }
    j.workspace = aligned;
    j.workspace_len++;

    /* Watched by one who writes into what he was given, and keeps it. */
    watcher scribbler = {.scribbles = 1};
    solve(k, &j, &scribbler);
    CHECK(same(&j, &clean) && scribbler.calls == clean.report.iterations);
    CHECK(scribbler.calls == 0 || scribbler.kept != NULL);

    static const int32_t answers[3] = {1, -1, INT_MIN};
    for (size_t stop_at = 1; stop_at <= clean.report.iterations; stop_at++) {
        cancel(k, &j, &clean, stop_at, answers[stop_at % 3]);
        if (stop_at % 5 == 0) {
            solve(k, &j, NULL);
            CHECK(same(&j, &clean));
        }
    }
    solve(k, &j, NULL);
    CHECK(same(&j, &clean));
    close_job(&j);
    close_job(&clean);
}

/* ---- several minima ---- */

/* A search numbers the iterations of every solve from 1. */
static int32_t watch_search(void *context, size_t iteration, const minvar_record *record) {
    watcher *w = context;
    CHECK(iteration >= 1 && record != NULL);
    w->calls++;
    return w->calls == w->stop_at ? w->answer : 0;
}

static void minima(const kind *k) {
    const minvar_curve curve = curve_of(k);
    job j = open_job(k);
    const size_t len = j.elements_len, room = (MINIMA + 1) * len;
    minvar_element *elements = guarded((room + BEYOND) * sizeof *elements);
    minvar_report reports[MINIMA];
    size_t all = 0, calls = 0;
    int counts[MINIMA + 1] = {0};
    for (size_t stop_at = 0; stop_at == 0 || stop_at <= calls; stop_at += stop_at < 5 ? 1 : 29) {
        watcher w = {.stop_at = stop_at, .answer = 1};
        size_t count = 99;
        memset(elements, PATTERN, (room + BEYOND) * sizeof *elements);
        memset(reports, PATTERN, sizeof reports);
        WORKS(minvar_curve_minima(&curve, &k->options, j.workspace, j.workspace_len, watch_search, &w, elements,
                                  room, reports, MINIMA, &count, e));
        CHECK(count <= MINIMA);
        if (stop_at == 0) {
            all = count;
            calls = w.calls;
        } else {
            CHECK(w.calls == stop_at);
        }
        for (size_t i = 0; i < count && i < MINIMA; i++) {
            CHECK(reports[i].status == MINVAR_CONVERGED && reports[i].elements == len);
            CHECK(whole(k, elements + i * len, len, len));
        }
        CHECK(count > MINIMA || untouched(reports + count, (MINIMA - count) * sizeof reports[0]));
        CHECK(untouched(elements + room, BEYOND * sizeof *elements));
        counts[count <= MINIMA ? count : 0]++;
    }
    CHECK(all >= 2 && calls > 50 && counts[0] > 0 && counts[1] > 0 && counts[all] > 0);
    release(elements, (room + BEYOND) * sizeof *elements);
    close_job(&j);
}

/* ---- a region: joints as they were, or both ends held ---- */

static void region(void) {
    minvar_element chain[3];
    minvar_joint joints[4];
    for (int i = 0; i < 4; i++) {
        joints[i] = minvar_joint_at(i, i % 2, 0);
    }
    const minvar_curve curve = minvar_curve_through(joints, 4, 0);
    const minvar_options options = minvar_options_defaults();
    static double workspace[4000];
    minvar_report report;
    minvar_error error;
    WORKS(minvar_curve_solve(&curve, &options, workspace, 4000, NULL, NULL, chain, 3, NULL, 0, &report, e));
    minvar_joint held[2] = {joints[1], joints[2]}, before[2];
    memcpy(before, held, sizeof held);
    minvar_element torn[3];
    memcpy(torn, chain, sizeof torn);
    torn[2].rows[1][0] = NAN; /* where the region's end is held */
    CHECK(minvar_region_hold(torn, 3, 0, 1, 1, held, 2, &error) == MINVAR_BAD_REFERENCE && error.index == 2);
    CHECK(memcmp(before, held, sizeof held) == 0); /* the first end neither, though it is good */
    WORKS(minvar_region_hold(chain, 3, 0, 1, 1, held, 2, e));
    CHECK(held[0].tangent[0].given == MINVAR_FIXED && held[1].tangent[0].given == MINVAR_FIXED);
}

/* ---- the kinds ---- */

static kind through(const char *name, const double (*points)[3], size_t count) {
    kind k;
    memset(&k, 0, sizeof k);
    k.name = name;
    k.count = count;
    for (size_t i = 0; i < count; i++) {
        k.joints[i] = minvar_joint_at(points[i][0], points[i][1], points[i][2]);
    }
    k.options = minvar_options_defaults();
    return k;
}

static const double WOODFORD[7][3] = {{0, 0, 0}, {1, 1.9, 0}, {2, 2.7, 0}, {3, 2.6, 0},
                                      {4, 1.6, 0}, {5, 0.89, 0}, {6, 1.2, 0}};
static const double SPACE[5][3] = {{0, 0, 0}, {1, 1, 0.3}, {2, 0.2, 1}, {3, 1, 1.2}, {3.5, 2, 2}};
static const double HELIX[5][3] = {{1, 0, 0}, {0.76, 0.64, 0.2}, {0.17, 0.98, 0.42}, {-0.5, 0.86, 0.6},
                                   {-0.94, 0.33, 0.84}};
static const double LOOP[5][3] = {{-1.5, 0, 0}, {-0.5, 0.5, 0}, {0, 1, 0}, {0.5, 0.5, 0}, {1.5, 0, 0}};
static const double RING[6][3] = {{2, 0, 0}, {1.3, 1.1, 0}, {-0.9, 0.8, 0}, {-2.2, 0, 0}, {-1.4, -1.2, 0},
                                  {1, -0.9, 0}};

int main(void) {
    kind k = through("seven points", WOODFORD, 7);
    faults_of(&k);
    k.options.elements_per_span = 4;
    k.name = "four elements a span";
    faults_of(&k);
    k.options.relative_decrease = 1e-6;
    k.name = "loosely asked";
    faults_of(&k);

    k = through("a continuation", WOODFORD, 7);
    k.options.continuation = 3;
    faults_of(&k);
    k = through("a length", WOODFORD, 7);
    k.options.length = 9;
    faults_of(&k);
    k = through("a tolerance", WOODFORD, 7);
    k.options.tolerance = 1e-5;
    k.options.elements_per_span = 64;
    faults_of(&k);
    k = through("a tolerance in space", SPACE, 5);
    k.options.tolerance = 1e-2;
    k.options.elements_per_span = 16;
    faults_of(&k);
    k = through("torsion", HELIX, 5);
    k.options.functional = MINVAR_SPACE_MEC;
    faults_of(&k);
    k = through("a ring", RING, 6);
    k.closed = 1;
    k.options.elements_per_span = 2;
    faults_of(&k);

    k = through("obstacles", WOODFORD, 2);
    coving(k.joints);
    k.joints[0].curvature[0].given = k.joints[0].curvature[1].given = MINVAR_FREE;
    const minvar_obstacle duct[2] = {{{0, -6, 0}, {6, -6, 0}, 0.25, MINVAR_LEFT},
                                     {{6, -6, 0}, {6, 0, 0}, 0.25, MINVAR_LEFT}};
    memcpy(k.obstacles, duct, sizeof duct);
    k.obstacle_count = 2;
    k.options.elements_per_span = 3;
    faults_of(&k);

    k = through("a last solution", SPACE, 5);
    k.warm = 1;
    k.options.relative_decrease = 0;
    faults_of(&k);

    k = through("a loop", LOOP, 5);
    k.joints[0] = minvar_joint_with_tangent(k.joints[0], MINVAR_INITIAL, 1, 0.1, 0);
    k.joints[2] = minvar_joint_with_tangent(k.joints[2], MINVAR_INITIAL, -1, 0, 0);
    k.joints[2] = minvar_joint_with_curvature(k.joints[2], MINVAR_FIXED, 0, -10, 0);
    k.joints[4] = minvar_joint_with_tangent(k.joints[4], MINVAR_INITIAL, 1, -0.1, 0);
    k.options.elements_per_span = 2;
    minima(&k);

    region();
    CHECK(cancelled > 150);
    return verdict();
}
