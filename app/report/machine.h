#pragma once
#include <string>

namespace lodestone {

// Where and with what something was measured. Empty where the system does not tell.
struct MachineFacts {
    std::string processor; // "AMD EPYC 7B13"
    unsigned threads = 0;  // of the machine
    std::string system;    // "Linux 6.1.0, Debian GNU/Linux 12 (bookworm)"
    std::string program;   // "Lodestone 0.1.0"
    std::string date;      // "2026-05-01", local time
};

MachineFacts thisMachine();

} // namespace lodestone
