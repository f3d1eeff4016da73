/* What stable Rust can't express: the C-variadic functions dsError, dsDebug and dsPrint; and what the library itself says,
   through the same buffers as the program's printf, so that lines come out in order. */
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

static void tell(const char *title, const char *format, va_list arguments) {
    fflush(stdout);
    fprintf(stderr, "%s: ", title);
    vfprintf(stderr, format, arguments);
    fputc('\n', stderr);
    fflush(stderr);
}

void ferrode_drawstuff_error(const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    tell("drawstuff: error", format, arguments);
    va_end(arguments);
    exit(1);
}

void ferrode_drawstuff_debug(const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    tell("drawstuff: wrong use", format, arguments);
    va_end(arguments);
    abort();
}

void ferrode_drawstuff_print(const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    vprintf(format, arguments);
    va_end(arguments);
}

/* Texts come from Rust with their lengths, not with a terminating zero. */
void ferrode_drawstuff_fail(int bug, const char *text, int length) {
    if (bug)
        ferrode_drawstuff_debug("%.*s", length, text);
    else
        ferrode_drawstuff_error("%.*s", length, text);
}

void ferrode_drawstuff_say(const char *text, int length) {
    fwrite(text, 1, (size_t)length, stdout);
    fflush(stdout);
}

void ferrode_drawstuff_warn(const char *text, int length) {
    fflush(stdout);
    fprintf(stderr, "drawstuff: %.*s\n", length, text);
}
