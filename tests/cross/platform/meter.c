/*
 * The stack below the caller is painted, and afterwards searched for the deepest place that has lost its colour.
 *
 * Instructions are counted by a timer of the emulated board: with `-icount shift=0` QEMU's clock goes on by a nanosecond an
 * instruction, and the timer counts every 40 of them (25 MHz). Under callgrind, that is asked to write what it counted into a
 * file of its own for every call, and the reading is the file's number.
 */
#include "meter.h"

#ifdef CALLGRIND
#include <valgrind/callgrind.h>
#endif

/* More than any call takes. What is nearer than the gap is the meter's own. */
enum { DEPTH = 256 * 1024, GAP = 256, PAINT = 0xa5 };

static volatile unsigned char *frame;

#ifdef __arm__
/* CMSDK timer 0 of MPS2: control, value, reload. */
static volatile uint32_t *const timer = (volatile uint32_t *)0x40000000;
enum { CONTROL, VALUE, RELOAD, NANOSECONDS = 40 };
static uint32_t started;

static void count(void) {
    timer[CONTROL] = 0;
    timer[RELOAD] = timer[VALUE] = UINT32_MAX;
    timer[CONTROL] = 1;
    started = timer[VALUE];
}

static uint64_t counted(void) { return (uint64_t)(started - timer[VALUE]) * NANOSECONDS; }
#elif defined CALLGRIND
static void count(void) { CALLGRIND_ZERO_STATS; }
static uint64_t counted(void) {
    static uint64_t files;
    CALLGRIND_DUMP_STATS;
    return ++files;
}
#else
static void count(void) {}
static uint64_t counted(void) { return 0; }
#endif

/* A stack that grows on demand is there after a frame that is as deep. */
__attribute__((noinline)) static void reach(void) {
    volatile unsigned char room[DEPTH];
    room[0] = PAINT;
    (void)room[0];
}

__attribute__((noinline)) void meter_start(void) {
    reach();
    frame = __builtin_frame_address(0);
    for (volatile unsigned char *place = frame - DEPTH; place < frame - GAP; place++) {
        *place = PAINT;
    }
    count();
}

__attribute__((noinline)) reading meter_stop(void) {
    reading result = {0, counted()};
    volatile const unsigned char *place = frame - DEPTH;
    while (place < frame - GAP && *place == PAINT) {
        place++;
    }
    result.stack = (size_t)(frame - place);
    return result;
}
