#include "bench/program_main.h"

#include "scene/result.h"

#include <exception>
#include <iostream>

namespace lodestone::bench {

int programMain(const char* name, int (*run)(int argc, char** argv), int argc, char** argv) {
    try {
        return run(argc, argv);
    } catch (const std::exception& exception) { // out of memory, or a bug
        std::cerr << name << ": " << exception.what() << '\n';
        return exitCode(ErrorKind::Failed);
    }
}

} // namespace lodestone::bench
