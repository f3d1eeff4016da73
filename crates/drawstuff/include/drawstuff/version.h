/* drawstuff/version.h: the number that programs put into dsFunctions. */
#ifndef FERRODE_DRAWSTUFF_VERSION_H
#define FERRODE_DRAWSTUFF_VERSION_H

#define DS_VERSION 0x0002

#endif
