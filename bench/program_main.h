#pragma once

namespace lodestone::bench {

// What run returns, or the exit code for what it throws, told on stderr with the program's name.
int programMain(const char* name, int (*run)(int argc, char** argv), int argc, char** argv);

} // namespace lodestone::bench
