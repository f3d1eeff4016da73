/* What stable Rust can't express: the C-variadic functions dError, dDebug and dMessage, and raising a fault of the
   library from a frame that owns nothing, so that a handler may leave by longjmp or by a C++ exception.

   Handlers are read and written atomically; a program may set them from any thread. */
#include <pthread.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

typedef void handler(int number, const char *format, va_list arguments);

enum { ERROR_HANDLER, DEBUG_HANDLER, MESSAGE_HANDLER };

static handler *handlers[3];
static const char *const titles[3] = {"ODE Error", "ODE INTERNAL ERROR", "ODE Message"};

handler *ferrode_ode_get_handler(int which) {
    return __atomic_load_n(&handlers[which], __ATOMIC_ACQUIRE);
}

void ferrode_ode_set_handler(int which, handler *fn) {
    __atomic_store_n(&handlers[which], fn, __ATOMIC_RELEASE);
}

static void tell(int which, int number, const char *format, va_list arguments) {
    handler *fn = ferrode_ode_get_handler(which);
    if (fn) {
        fn(number, format, arguments);
        return;
    }
    fflush(stdout);
    fflush(stderr);
    if (number)
        fprintf(stderr, "\n%s %d: ", titles[which], number);
    else
        fprintf(stderr, "\n%s: ", titles[which]);
    vfprintf(stderr, format, arguments);
    fputc('\n', stderr);
    fflush(stderr);
}

void ferrode_ode_message(int number, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    tell(MESSAGE_HANDLER, number, format, arguments);
    va_end(arguments);
}

void ferrode_ode_error(int number, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    tell(ERROR_HANDLER, number, format, arguments);
    va_end(arguments);
    exit(1);
}

void ferrode_ode_debug(int number, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    tell(DEBUG_HANDLER, number, format, arguments);
    va_end(arguments);
    abort();
}

/* Texts come from Rust with their lengths, not with a terminating zero. */
void ferrode_ode_raise(int number, const char *text, int text_length, const char *name, int name_length) {
    ferrode_ode_debug(number, "%.*s in %.*s()", text_length, text, name_length, name);
}

void ferrode_ode_warn(int number, const char *text, int text_length, const char *name, int name_length) {
    if (name_length)
        ferrode_ode_message(number, "%.*s in %.*s()", text_length, text, name_length, name);
    else
        ferrode_ode_message(number, "%.*s", text_length, text);
}

/* One lock a kind of record, then sixteen that the contents of records share. They are the C library's, so that the race
   checkers of C programs see them. */
#define FOUR PTHREAD_MUTEX_INITIALIZER, PTHREAD_MUTEX_INITIALIZER, PTHREAD_MUTEX_INITIALIZER, PTHREAD_MUTEX_INITIALIZER
static pthread_mutex_t locks[32] = {FOUR, FOUR, FOUR, FOUR, FOUR, FOUR, FOUR, FOUR};

void ferrode_ode_lock(int which) { pthread_mutex_lock(&locks[which]); }
void ferrode_ode_unlock(int which) { pthread_mutex_unlock(&locks[which]); }
