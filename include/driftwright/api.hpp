#pragma once
// What the shared library shows to programs that link it; everything else in it is hidden.

#define DRIFTWRIGHT_API __attribute__((visibility("default")))
