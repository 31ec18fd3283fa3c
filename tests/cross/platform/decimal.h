/* Whole numbers in words: there is no C library where this runs. */
#ifndef DECIMAL_H
#define DECIMAL_H

#include <stddef.h>
#include <stdint.h>

/* The digits of a number, somewhere in `room`. */
static inline const char *decimal(uint64_t value, char room[24]) {
    size_t first = 23;
    room[first] = '\0';
    do {
        room[--first] = (char)('0' + value % 10);
        value /= 10;
    } while (value != 0);
    return room + first;
}

#endif
