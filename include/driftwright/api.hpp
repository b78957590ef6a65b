#pragma once
// Marks what the shared library exports to programs that link it; every other symbol in it is hidden.

#define DRIFTWRIGHT_API __attribute__((visibility("default")))
