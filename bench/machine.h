#pragma once
// What the figures were taken on.
#include <string>

namespace lodestone::bench {

// Markdown list: processor, cores, memory, system, compiler, load before the run.
std::string machineText();

// The commit of the sources, "with changes" where files differ from it; "unknown" without git.
std::string commitText();

} // namespace lodestone::bench
