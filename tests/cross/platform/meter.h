/* How deep a call's stack is, and how many instructions it takes. */
#ifndef METER_H
#define METER_H

#include <stddef.h>
#include <stdint.h>

typedef struct {
    /* Bytes between the caller's frame and the deepest byte that was written. */
    size_t stack;
    /* On a Cortex-M under `-icount shift=0`, to 40; on a machine of its own 0: there callgrind writes them to files. */
    uint64_t instructions;
} reading;

/* What lies between the two is measured; the call that is meant should be the only one. */
void meter_start(void);
reading meter_stop(void);

#endif
