#pragma once

// The header of glibc 2.36, Debian 12's, forgets to say that these are C
// functions (glibc bug 29697).
extern "C" {
#include <sys/pidfd.h>
}
