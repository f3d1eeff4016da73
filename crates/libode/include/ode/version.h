/* The version of ODE whose interface this is. */
#ifndef FERRODE_ODE_VERSION_H
#define FERRODE_ODE_VERSION_H

#define dODE_VERSION "0.16.2"

#endif
