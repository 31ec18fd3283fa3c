/* Counts the heap's calls while the library works. This program brings the heap itself, so that every call of it, from
 * wherever it comes, is seen: those of C and the system's beneath. Prints the name of each function of the interface
 * that was called while it counted, read off the call itself. */
#define _GNU_SOURCE
#include "check.h"

#include <errno.h>
#include <stdlib.h>
#include <sys/types.h>

/* ---- a heap that counts ---- */

static unsigned long heap_calls;
static _Alignas(64) unsigned char arena[1 << 20];
static size_t used;

static void *take(size_t alignment, size_t size) {
    heap_calls++;
    const size_t from = (used + 16 + alignment - 1) / alignment * alignment;
    if (size > sizeof arena - from) {
        return NULL;
    }
    memcpy(arena + from - sizeof size, &size, sizeof size);
    used = from + size;
    return arena + from;
}

void *malloc(size_t size) { return take(16, size); }

void *calloc(size_t count, size_t size) {
    void *place = size != 0 && count > sizeof arena / size ? NULL : take(16, count * size);
    return place != NULL ? memset(place, 0, count * size) : NULL;
}

void *realloc(void *old, size_t size) {
    void *place = take(16, size);
    if (place != NULL && old != NULL) {
        size_t before;
        memcpy(&before, (unsigned char *)old - sizeof before, sizeof before);
        memcpy(place, old, before < size ? before : size);
    }
    return place;
}

void *reallocarray(void *old, size_t count, size_t size) { return realloc(old, count * size); }
void *aligned_alloc(size_t alignment, size_t size) { return take(alignment, size); }
void *memalign(size_t alignment, size_t size);
void *memalign(size_t alignment, size_t size) { return take(alignment, size); }
void *valloc(size_t size) { return take(4096, size); }
void *pvalloc(size_t size);
void *pvalloc(size_t size) { return take(4096, size); }

int posix_memalign(void **place, size_t alignment, size_t size) {
    *place = take(alignment, size);
    return *place != NULL ? 0 : ENOMEM;
}

/* What is given back is counted too, and kept. */
void free(void *place) {
    (void)place;
    heap_calls++;
}

void *mmap(void *at, size_t length, int protection, int flags, int file, off_t offset);
void *mmap(void *at, size_t length, int protection, int flags, int file, off_t offset) {
    (void)at, (void)length, (void)protection, (void)flags, (void)file, (void)offset;
    heap_calls++;
    return (void *)-1;
}

int munmap(void *at, size_t length);
int munmap(void *at, size_t length) {
    (void)at, (void)length;
    heap_calls++;
    return -1;
}

int brk(void *end);
int brk(void *end) {
    (void)end;
    heap_calls++;
    return -1;
}

void *sbrk(intptr_t by);
void *sbrk(intptr_t by) {
    (void)by;
    heap_calls++;
    return (void *)-1;
}

/* ---- counting ---- */

static char counted[8192];

/* Notes every function of the interface that a call names. */
static void note(const char *call) {
    for (const char *at = call; (at = strstr(at, "minvar_")) != NULL;) {
        const size_t length = strspn(at, "abcdefghijklmnopqrstuvwxyz0123456789_");
        char line[128];
        snprintf(line, sizeof line, "counted %.*s\n", (int)length, at);
        if (at[length] == '(' && strstr(counted, line) == NULL) {
            strncat(counted, line, sizeof counted - strlen(counted) - 1);
        }
        at += length;
    }
}

/* A call that must not touch the heap. */
#define COUNTED(...) \
    do { \
        const unsigned long before_ = heap_calls; \
        __VA_ARGS__; \
        const unsigned long calls_ = heap_calls - before_; \
        if (calls_ != 0) { \
            failures++; \
            printf("%s:%d: %lu calls of the heap: %s\n", __FILE__, __LINE__, calls_, #__VA_ARGS__); \
        } \
        note(#__VA_ARGS__); \
    } while (0)

/* ... that does what it says, or is refused with this code. */
#define CODE(wanted, call) \
    do { \
        minvar_error error_; \
        minvar_error *const e = &error_; \
        minvar_code code_; \
        COUNTED(code_ = (call)); \
        if (code_ != (wanted)) { \
            failures++; \
            printf("%s:%d: code %d: %s: %s\n", __FILE__, __LINE__, (int)code_, error_.message, #call); \
        } \
    } while (0)

/* The counting itself: each of the heap's functions, called on purpose by a pointer that no compiler sees through. */
static void the_count_counts(void) {
    void *(*volatile one)(size_t) = malloc;
    void *(*volatile many)(size_t, size_t) = calloc;
    void *(*volatile again)(void *, size_t) = realloc;
    void *(*volatile at)(size_t, size_t) = aligned_alloc;
    int (*volatile posix)(void **, size_t, size_t) = posix_memalign;
    void (*volatile back)(void *) = free;
    void *(*volatile more)(intptr_t) = sbrk;
    void *(*volatile map)(void *, size_t, int, int, int, off_t) = mmap;
    const unsigned long before = heap_calls;
    void *place = one(10);
    CHECK(place != NULL && heap_calls - before == 1);
    place = again(place, 20);
    back(many(3, 4));
    back(at(64, 64));
    CHECK(heap_calls - before == 6);
    CHECK(posix(&place, 64, 10) == 0 && more(0) == (void *)-1 && map(NULL, 1, 0, 0, -1, 0) == (void *)-1);
    CHECK(heap_calls - before == 9);
}

/* ---- the callbacks ---- */

static int32_t watch(void *context, size_t iteration, const minvar_record *record) {
    (void)record;
    return context != NULL && iteration == *(const size_t *)context;
}

static int32_t visit(void *context, const minvar_move *step) {
    (void)step;
    return context != NULL && ++*(int *)context > 2;
}

static int32_t print(void *context, const char *text, size_t length) {
    (void)text;
    size_t *room = context;
    if (length > *room) {
        return 1;
    }
    *room -= length;
    return 0;
}

/* ---- every function ---- */

enum { ROOM = 60000, ELEMENTS = 64, MINIMA = 3 };

static double workspace[ROOM];
static minvar_element elements[ELEMENTS * (MINIMA + 1)], kept[ELEMENTS];
static minvar_record records[50];
static minvar_report report, reports[MINIMA];
static minvar_options options;

static void solve(const minvar_curve *curve, minvar_status status) {
    size_t len = 0, stop_at = 2;
    CODE(MINVAR_OK, minvar_curve_workspace_len(curve, &options, &len, e));
    size_t count = 0;
    COUNTED(count = minvar_curve_elements_len(curve, &options));
    CHECK(len > 0 && len <= ROOM && count > 0 && count <= ELEMENTS);
    CODE(MINVAR_WORKSPACE_TOO_SMALL,
         minvar_curve_solve(curve, &options, workspace, len - 1, NULL, NULL, elements, count, records, 50, &report, e));
    CODE(MINVAR_OK, minvar_curve_solve(curve, &options, workspace, len, watch, &stop_at, elements, count, records, 50,
                                       &report, e));
    CODE(MINVAR_OK, minvar_curve_solve(curve, &options, workspace, len, watch, NULL, elements, count, records, 50,
                                       &report, e));
    CHECK(report.status == status);
    if (report.status != status) {
        printf("    status %d, not %d\n", (int)report.status, (int)status);
    }
}

static void curves(void) {
    minvar_joint joints[7], joint;
    COUNTED(joint = minvar_joint_at(0, 0, 0));
    COUNTED(joint = minvar_joint_on_line(joint, 0, 0, 0, 1, 0, 0));
    COUNTED(joint = minvar_joint_on_plane(joint, 0, 0, 0, 0, 0, 1));
    COUNTED(joint = minvar_joint_with_tangent(joint, MINVAR_INITIAL, 1, 0, 0));
    COUNTED(joint = minvar_joint_with_curvature(joint, MINVAR_INITIAL, 0, 1, 0));
    COUNTED(joint = minvar_joint_with_continuity(joint, MINVAR_G1));
    static const double woodford[7][2] = {{0, 0}, {1, 1.9}, {2, 2.7}, {3, 2.6}, {4, 1.6}, {5, 0.89}, {6, 1.2}};
    for (int i = 0; i < 7; i++) {
        joints[i] = minvar_joint_at(woodford[i][0], woodford[i][1], 0);
    }
    minvar_curve curve;
    COUNTED(curve = minvar_curve_through(joints, 7, 0));
    COUNTED(options = minvar_options_defaults());

    /* Every way that a solve goes. */
    solve(&curve, MINVAR_CONVERGED);
    options.elements_per_span = 4;
    solve(&curve, MINVAR_CONVERGED);
    options.relative_decrease = 1e-6;
    solve(&curve, MINVAR_CONVERGED);
    options = minvar_options_defaults();
    options.functional = MINVAR_SI_MEC;
    solve(&curve, MINVAR_CONVERGED);
    options = minvar_options_defaults();
    options.length = 9;
    solve(&curve, MINVAR_CONVERGED);
    options = minvar_options_defaults();
    options.tolerance = 1e-3;
    options.elements_per_span = 8;
    solve(&curve, MINVAR_CONVERGED);
    options = minvar_options_defaults();
    options.continuation = 2;
    solve(&curve, MINVAR_CONVERGED);
    options = minvar_options_defaults();
    options.dimension = 3;
    options.max_iterations = 3;
    solve(&curve, MINVAR_ITERATION_LIMIT);

    minvar_joint helix[5];
    static const double turns[5][3] = {{1, 0, 0}, {0.76, 0.64, 0.2}, {0.17, 0.98, 0.42}, {-0.5, 0.86, 0.6},
                                       {-0.94, 0.33, 0.84}};
    for (int i = 0; i < 5; i++) {
        helix[i] = minvar_joint_at(turns[i][0], turns[i][1], turns[i][2]);
    }
    helix[2] = minvar_joint_on_plane(helix[2], 0.17, 0.98, 0.42, 0, 0, 1);
    const minvar_curve space = minvar_curve_through(helix, 5, 0);
    options = minvar_options_defaults();
    solve(&space, MINVAR_CONVERGED);
    helix[2] = minvar_joint_at(0.17, 0.98, 0.42);
    options.functional = MINVAR_SPACE_MEC;
    solve(&space, MINVAR_CONVERGED);

    minvar_joint apart[2];
    for (int i = 0; i < 2; i++) {
        apart[i] = minvar_joint_with_tangent(minvar_joint_at(4 * i - 2, 0, 0), MINVAR_FIXED, -0.5, 1, 0);
    }
    const minvar_curve unbounded = minvar_curve_through(apart, 2, 0);
    options = minvar_options_defaults();
    solve(&unbounded, MINVAR_UNBOUNDED);

    minvar_joint wall[2];
    coving(wall);
    wall[0].curvature[0].given = wall[0].curvature[1].given = MINVAR_FREE;
    const minvar_obstacle duct[2] = {{{0, -6, 0}, {6, -6, 0}, 0.25, MINVAR_LEFT},
                                     {{6, -6, 0}, {6, 0, 0}, 0.25, MINVAR_LEFT}};
    minvar_curve clear = minvar_curve_through(wall, 2, 0);
    clear.obstacles = duct;
    clear.obstacle_count = 2;
    options.elements_per_span = 3;
    solve(&clear, MINVAR_CONVERGED);

    options = minvar_options_defaults();
    solve(&curve, MINVAR_CONVERGED);
    memcpy(kept, elements, 6 * sizeof kept[0]);
    joints[3].position.value[1] = 2.7;
    curve.reference = kept;
    curve.reference_count = 6;
    curve.reference_weight = 0.5;
    solve(&curve, MINVAR_CONVERGED);
    curve = minvar_curve_through(joints, 7, 0);
    memcpy(elements, kept, 6 * sizeof kept[0]);
    CODE(MINVAR_OK,
         minvar_curve_update(&curve, &options, workspace, ROOM, watch, NULL, elements, 6, &report, e));
    CHECK(report.status == MINVAR_CONVERGED);
    memset(elements, 0, sizeof elements);
    CODE(MINVAR_BAD_REFERENCE,
         minvar_curve_update(&curve, &options, workspace, ROOM, NULL, NULL, elements, 6, &report, e));
    size_t count = 0;
    CODE(MINVAR_OK, minvar_curve_minima(&curve, &options, workspace, ROOM, watch, NULL, elements, 6 * (MINIMA + 1),
                                        reports, MINIMA, &count, e));
    CHECK(count >= 1);
    size_t stop_at = 2;
    CODE(MINVAR_OK, minvar_curve_minima(&curve, &options, workspace, ROOM, watch, &stop_at, elements, 6 * (MINIMA + 1),
                                        reports, MINIMA, &count, e));

    /* Refusals of all kinds: the sentence is made without a heap too. */
    joints[2].position.value[0] = NAN;
    CODE(MINVAR_JOINT_NOT_FINITE,
         minvar_curve_solve(&curve, &options, workspace, ROOM, NULL, NULL, elements, 6, NULL, 0, &report, e));
    CODE(MINVAR_NULL_POINTER,
         minvar_curve_solve(NULL, &options, workspace, ROOM, NULL, NULL, elements, 6, NULL, 0, &report, e));
    options.length = -1;
    CODE(MINVAR_BAD_OPTION,
         minvar_curve_solve(&curve, &options, workspace, ROOM, NULL, NULL, elements, 6, NULL, 0, &report, e));
}

static void chains(void) {
    minvar_figures figures;
    minvar_point point;
    CODE(MINVAR_OK, minvar_measure(kept, 6, &figures, e));
    CODE(MINVAR_OK, minvar_point_at(kept, 6, 2, 0.5, &point, e));
    CODE(MINVAR_OUT_OF_RANGE, minvar_point_at(kept, 6, 9, 0.5, &point, e));
    CODE(MINVAR_OK, minvar_point_at_length(kept, 6, 2, &point, e));
    CODE(MINVAR_OK, minvar_closest_point(kept, 6, 3, 3, 0, &point, e));
    minvar_joint held[2];
    COUNTED(held[0] = minvar_joint_held_at(point));
    held[0] = minvar_joint_at(1, 1.9, 0);
    held[1] = minvar_joint_at(3, 2.6, 0);
    CODE(MINVAR_OK, minvar_region_hold(kept, 6, 0, 1, 2, held, 2, e));
    CODE(MINVAR_BAD_REGION, minvar_region_hold(kept, 6, 0, 5, 2, held, 2, e));

    double bezier[6][3], controls[40][3], knots[60];
    size_t control_count, knot_count;
    CODE(MINVAR_OK, minvar_element_bezier(&kept[0], &bezier, e));
    CODE(MINVAR_OK, minvar_bspline_len(kept, 6, &control_count, &knot_count, e));
    CODE(MINVAR_OK, minvar_bspline(kept, 6, controls, 40, knots, 60, e));
    CODE(MINVAR_RESULT_TOO_SHORT, minvar_bspline(kept, 6, controls, 2, knots, 60, e));

    int two = 0;
    CODE(MINVAR_OK, minvar_chords(kept, 6, 1e-4, visit, NULL, e));
    CODE(MINVAR_STOPPED, minvar_chords(kept, 6, 1e-4, visit, &two, e));
    CODE(MINVAR_OK, minvar_arcs(kept, 6, 1e-4, visit, NULL, e));
    minvar_gcode_options gcode;
    COUNTED(gcode = minvar_gcode_defaults(1e-3, 600, 5));
    minvar_gcode_summary summary;
    size_t room = 100000;
    for (uint32_t motion = MINVAR_ARCS; motion <= MINVAR_CHORDS; motion++) {
        gcode.motion = motion;
        gcode.comments = 1;
        CODE(MINVAR_OK, minvar_write_gcode(kept, 6, &gcode, print, &room, &summary, e));
    }
    room = 100;
    CODE(MINVAR_STOPPED, minvar_write_gcode(kept, 6, &gcode, print, &room, &summary, e));
    gcode.safe_height = -1;
    CODE(MINVAR_BAD_SAFE_HEIGHT, minvar_write_gcode(kept, 6, &gcode, print, &room, &summary, e));

    const char *text;
    int32_t same;
    COUNTED(text = minvar_version());
    CHECK(text != NULL);
    COUNTED(same = minvar_abi_check(MINVAR_ABI));
    CHECK(same == 1);
    for (uint32_t status = 0; status < 8; status++) {
        COUNTED(text = minvar_status_sentence(status));
        CHECK(text != NULL);
    }
}

int main(void) {
    the_count_counts();
    curves();
    chains();
    printf("%s", counted);
    return verdict();
}
