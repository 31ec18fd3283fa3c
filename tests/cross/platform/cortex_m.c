/*
 * A Cortex-M without anything: reset, faults, and semihosting for text and the end (the debugger, here the emulator, does
 * what a breakpoint with the number 0xab asks for).
 */
#include <stdint.h>

#include "platform.h"

enum { WRITE0 = 0x04, EXIT_EXTENDED = 0x20, APPLICATION_EXIT = 0x20026 };

static int32_t semihost(uint32_t operation, const void *argument) {
    register uint32_t r0 __asm__("r0") = operation;
    register const void *r1 __asm__("r1") = argument;
    __asm__ volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
    return (int32_t)r0;
}

void platform_print(const char *text) { semihost(WRITE0, text); }

static _Noreturn void leave(uint32_t code) {
    const uint32_t how[2] = {APPLICATION_EXIT, code};
    for (;;) {
        semihost(EXIT_EXTENDED, how);
    }
}

int main(void);

extern uint32_t data_image[], data_start[], data_end[], bss_start[], bss_end[], stack_top[];

_Noreturn void reset(void);
_Noreturn void reset(void) {
    /* The floating-point unit is off at first (CPACR). */
    *(volatile uint32_t *)0xe000ed88 |= UINT32_C(0xf) << 20;
    __asm__ volatile("dsb\n isb");
    const uint32_t *from = data_image;
    for (uint32_t *to = data_start; to < data_end;) {
        *to++ = *from++;
    }
    for (uint32_t *to = bss_start; to < bss_end;) {
        *to++ = 0;
    }
    leave((uint32_t)main());
}

static _Noreturn void fault(void) {
    semihost(WRITE0, "fault\n");
    leave(99);
}

typedef union {
    uint32_t *stack;
    void (*handler)(void);
} vector;

__attribute__((section(".vectors"), used)) const vector vectors[16] = {
    {.stack = stack_top}, {.handler = reset}, {.handler = fault}, {.handler = fault},
    {.handler = fault},   {.handler = fault}, {.handler = fault}, {.handler = fault}};
