// The start of a package's program for any amd64 processor, and nothing else of it.
#include <cstdio>

#include "app/fastest_build.h"

int main(int, char** arguments) {
  tailwater::become_fastest_build(arguments);
  std::puts("x86-64-v2");
}
