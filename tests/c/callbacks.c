/* The caller's functions: an observer that watches and cancels, a visitor and a writer that stop. And memory: dirty
 * workspaces, records as far as they reach. */
#include "check.h"

enum { ROOM = 20000, ELEMENTS = 8, RECORDS = 200 };

static double workspace[ROOM];

typedef struct {
    size_t stop_at;
    size_t calls;
    double values[RECORDS];
} watcher;

static int32_t observe(void *context, size_t iteration, const minvar_record *record) {
    watcher *w = context;
    CHECK(iteration == w->calls + 1);
    w->values[w->calls] = record->value;
    w->calls++;
    return iteration == w->stop_at;
}

typedef struct {
    minvar_element elements[ELEMENTS];
    minvar_record records[RECORDS];
    minvar_report report;
} result;

static void solve(result *r, unsigned char dirt, size_t records_len, watcher *w) {
    minvar_joint joints[2];
    coving(joints);
    const minvar_curve curve = minvar_curve_through(joints, 2, 0);
    minvar_options options = minvar_options_defaults();
    options.elements_per_span = ELEMENTS;
    memset(workspace, dirt, sizeof workspace);
    memset(r, 0, sizeof *r);
    WORKS(minvar_curve_solve(&curve, &options, workspace, ROOM, w != NULL ? observe : NULL, w, r->elements, ELEMENTS,
                             r->records, records_len, &r->report, e));
}

static int same(const result *a, const result *b) {
    return memcmp(a->elements, b->elements, sizeof a->elements) == 0 &&
           memcmp(&a->report.status, &b->report.status, sizeof a->report.status) == 0 &&
           memcmp(&a->report.value, &b->report.value, sizeof(double)) == 0 &&
           a->report.iterations == b->report.iterations;
}

static result clean, other;

static void memory(void) {
    solve(&clean, 0, RECORDS, NULL);
    CHECK(clean.report.status == MINVAR_CONVERGED);
    /* All bits set are NaNs, 0x7f huge numbers, 1 tiny ones; then as the last solve left it. */
    static const unsigned char dirt[3] = {0xff, 0x7f, 0x01};
    for (int i = 0; i < 3; i++) {
        solve(&other, dirt[i], RECORDS, NULL);
        CHECK(same(&clean, &other));
    }
    static const minvar_record none;
    CHECK(memcmp(&clean.records[clean.report.iterations - 1], &none, sizeof none) != 0);
    CHECK(memcmp(&clean.records[clean.report.iterations], &none, sizeof none) == 0);
    solve(&other, 0, 2, NULL);
    CHECK(same(&clean, &other));
    CHECK(memcmp(clean.records, other.records, 2 * sizeof none) == 0);
    CHECK(memcmp(&other.records[2], &none, sizeof none) == 0);
}

static void observer(void) {
    static watcher w;
    solve(&other, 0, RECORDS, &w);
    CHECK(same(&clean, &other));
    CHECK(w.calls == clean.report.iterations);
    for (size_t i = 0; i < w.calls; i++) {
        CHECK(w.values[i] == clean.records[i].value);
    }
    for (size_t stop = 1; stop < clean.report.iterations; stop++) {
        watcher early = {.stop_at = stop};
        solve(&other, 0, RECORDS, &early);
        CHECK(other.report.status == MINVAR_CANCELLED);
        CHECK(early.calls == stop && other.report.iterations == stop);
        /* The best curve so far is a curve through the joints. */
        CHECK(other.elements[0].rows[0][1] == -12.0 && other.elements[ELEMENTS - 1].rows[5][0] == 20.0);
        CHECK(isfinite(other.report.variation) && other.report.variation >= clean.report.variation * (1 - 1e-12));
    }
}

typedef struct {
    size_t calls, stop_after;
    double end[3];
    double deviation;
    int arcs;
} visited;

static int32_t visit(void *context, const minvar_move *step) {
    visited *v = context;
    memcpy(v->end, step->end, sizeof v->end);
    v->deviation = fmax(v->deviation, step->deviation);
    v->arcs += step->turn != 0;
    return ++v->calls == v->stop_after;
}

static void visitor(void) {
    minvar_error error;
    const double tolerance = 1e-3;
    visited chords = {0}, arcs = {0};
    WORKS(minvar_chords(clean.elements, ELEMENTS, tolerance, visit, &chords, e));
    WORKS(minvar_arcs(clean.elements, ELEMENTS, tolerance, visit, &arcs, e));
    CHECK(chords.arcs == 0 && arcs.arcs > 0 && chords.calls > arcs.calls);
    CHECK(chords.deviation <= tolerance && arcs.deviation <= tolerance && arcs.deviation > 0);
    CHECK(chords.end[0] == 20.0 && chords.end[1] == -0.5 && arcs.end[0] == 20.0 && arcs.end[1] == -0.5);
    for (size_t stop = 1; stop <= arcs.calls; stop++) {
        visited early = {.stop_after = stop};
        CHECK(minvar_arcs(clean.elements, ELEMENTS, tolerance, visit, &early, &error) == MINVAR_STOPPED);
        CHECK(early.calls == stop && strstr(error.message, "visitor") != NULL);
        early = (visited){.stop_after = stop};
        CHECK(minvar_chords(clean.elements, ELEMENTS, tolerance, visit, &early, NULL) == MINVAR_STOPPED);
        CHECK(early.calls == stop);
    }
}

typedef struct {
    char text[20000];
    size_t length, room;
    int failed;
} paper;

static int32_t print(void *context, const char *text, size_t length) {
    paper *p = context;
    CHECK(!p->failed); /* nobody writes on after a failure */
    if (length > p->room - p->length) {
        p->failed = 1;
        return -1;
    }
    memcpy(p->text + p->length, text, length);
    p->length += length;
    return 0;
}

static void writer(void) {
    static paper whole = {.room = sizeof whole.text};
    const minvar_gcode_options options = minvar_gcode_defaults(1e-3, 40, 2);
    minvar_gcode_summary summary;
    WORKS(minvar_write_gcode(clean.elements, ELEMENTS, &options, print, &whole, &summary, e));
    size_t lines = 0;
    for (size_t i = 0; i < whole.length; i++) {
        lines += whole.text[i] == '\n';
    }
    CHECK(lines == summary.lines && summary.arcs > 0 && summary.deviation <= 1e-3);
    CHECK(memcmp(whole.text, "G21\nG17\n", 8) == 0 && memcmp(whole.text + whole.length - 4, "\nM2\n", 4) == 0);
    NEAR(summary.length, clean.report.length, 1e-4);
    NEAR(summary.minutes, summary.length / 40, 1e-12);

    /* Paper that runs out after any number of characters. */
    for (size_t room = 0; room < whole.length; room++) {
        static paper p;
        minvar_error error;
        p.length = 0;
        p.failed = 0;
        p.room = room;
        memset(&summary, 0xA5, sizeof summary);
        const minvar_gcode_summary before = summary;
        CHECK(minvar_write_gcode(clean.elements, ELEMENTS, &options, print, &p, &summary, &error) == MINVAR_STOPPED);
        CHECK(error.code == MINVAR_STOPPED && strstr(error.message, "incomplete") != NULL);
        CHECK(memcmp(&summary, &before, sizeof summary) == 0);
        CHECK(memcmp(p.text, whole.text, p.length) == 0);
    }
}

int main(void) {
    memory();
    observer();
    visitor();
    writer();
    return verdict();
}
