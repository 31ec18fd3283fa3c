/*
 * The corpus of tests/cross: problems whose every output has the same bits on every machine.
 *
 * It is a program of a user of the C library and nothing else: freestanding C11 over minvar.h, no libc, no heap. What is
 * computed comes as lines, one for each part of a case: a name, a hash of all its numbers and how it ended in a word.
 * `make cross` runs it everywhere and compares with hashes.txt; `make cross-hashes` writes that file anew.
 *
 * To add a case: a call of course() with another name in the file of its kind. To add a layer: a file with one function
 * that names each case by begin(), hashes what it computes by add_…() into a digest and hands it over by end(); declare the
 * function here and call it in corpus(). Then `make cross-hashes`, and `make cross`.
 *
 * A case must fit a microcontroller of 4 MB, and one whose double arithmetic is software, under an emulator: that is 500
 * times slower than the machine at the desk. Whoever makes a case smaller makes it smaller everywhere. Cases named `long/…`
 * are for `make cross` alone; the others, which take a desk a tenth of a second, are for every push.
 */
#ifndef CORPUS_H
#define CORPUS_H

#include "digest.h"
#include "minvar.h"

enum {
    MOST_JOINTS = 16,
    MOST_OBSTACLES = 4,
    MOST_ELEMENTS = 256,
    MOST_WORKSPACE = 160 * 1024,
    /* What crawls is cut off here. */
    MOST_ITERATIONS = 15,
};

/* Receives the lines. */
typedef void (*corpus_listener)(const char *name, uint64_t hash, const char *outcome);

/* Computes everything, with the long cases or without. */
void corpus(corpus_listener listener, int with_long);

/* ---- for those who write cases ---- */

/* Names the case that follows; NULL ends the name early. The parts are joined by '/'. */
void begin(const char *first, const char *second, const char *third);

/* The name's last part with a number, for cases that are counted. */
void begin_number(const char *first, const char *second, unsigned number);

/* One line: what was computed under `part` of the case, and how it ended. */
void end(const char *part, const digest *sum, const char *outcome);

/* The words for a code and for a status. */
const char *code_word(minvar_code code);
const char *status_word(minvar_status status);

/* Everything that a call says of an error: code, numbers and message. */
void add_error(digest *sum, minvar_code code, const minvar_error *error);
void add_report(digest *sum, const minvar_report *report);
void add_elements(digest *sum, const minvar_element *elements, size_t count);
void add_point(digest *sum, const minvar_point *point);

/* A curve and what is asked of it. */
typedef struct {
    minvar_joint joints[MOST_JOINTS];
    size_t joint_count;
    int32_t closed;
    minvar_obstacle obstacles[MOST_OBSTACLES];
    size_t obstacle_count;
    const minvar_element *reference;
    double reference_weight;
    minvar_options options;
    /* The iteration at which the observer cancels; 0: never. */
    size_t cancel_at;
} problem;

/* No joints; the default options, but for MOST_ITERATIONS. */
problem blank(void);
minvar_curve curve_of(const problem *data);

/* What the last solve left. */
extern minvar_element elements[2 * MOST_ELEMENTS];
extern minvar_report report;
extern double workspace[MOST_WORKSPACE];

/* Solves a problem, or computes it anew from `elements`; hashes report, elements and history. 1 if there is a curve. */
int solve(const problem *data);
int update(const problem *data);

/* Hashes what is measured and converted, and the paths, of the last curve. */
void measured(void);
void paths(void);

/* All of it, or as far as is asked. 1 if there is a curve. */
typedef enum { SOLVE, MEASURE, MAKE_PATHS } extent;
int course(const problem *data, extent how_far);

/* ---- the files of the corpus ---- */

void appendix_a(void);
void more_of_appendix_a(void);
void random_curves(void);
void more_random_curves(void);
void endings(void);
void refusals(void);

#endif
