#include "app/log.h"

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

namespace lodestone {

void logToStderr() {
    spdlog::set_default_logger(spdlog::stderr_color_mt("lodestone"));
}

} // namespace lodestone
