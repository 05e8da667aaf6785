#pragma once
#include <string>

namespace lodestone {

// What every page of ours has around its content.
struct PageFrame {
    std::string program; // name and version of what wrote it
    std::string title;   // of the browser's tab
    std::string kind;    // of page, after the brand
    std::string heading;
    std::string subject; // markup: the line below the heading
    std::string footer;
};

// A page that needs no other file and asks the network for nothing; light or dark as the reader's
// system is, with a switch. content: markup; of the frame all but the subject is escaped here.
std::string framedPage(const PageFrame& frame, const std::string& content);

} // namespace lodestone
