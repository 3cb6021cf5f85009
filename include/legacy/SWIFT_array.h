/* For programs that include it: the arrays inside SWIFT are not offered, std::vector does what they did. */
#ifndef SWIFT_ARRAY_H
#define SWIFT_ARRAY_H

#include "SWIFT_common.h"

#endif
