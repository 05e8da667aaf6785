#include "app/report/html_frame.h"

#include "app/report/html_sections.h"
#include "app/report/html_text.h"

#include <fmt/core.h>

namespace lodestone {

namespace {

std::string head(const PageFrame& frame) {
    return fmt::format(
        R"(<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8"/>
<meta name="viewport" content="width=device-width, initial-scale=1"/>
<meta name="color-scheme" content="dark light"/>
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; img-src data:; style-src 'unsafe-inline'; script-src 'unsafe-inline'"/>
<meta name="generator" content="{}"/>
<title>{}</title>
<link rel="icon" href="data:,"/>
<style>/*<![CDATA[*/
{}/*]]>*/</style>
</head>
)",
        escaped(frame.program),
        escaped(frame.title),
        pageStyle());
}

std::string titleBar(const PageFrame& frame) {
    return fmt::format(
        R"(<header class="top">
<div>
<p class="brand">Lodestone <span>{}</span></p>
<h1>{}</h1>
<p class="target">{}</p>
</div>
<button type="button" id="theme" class="button" hidden="hidden" aria-label="Switch between light and dark">Light</button>
</header>
)",
        escaped(frame.kind),
        escaped(frame.heading),
        frame.subject);
}

} // namespace

std::string framedPage(const PageFrame& frame, const std::string& content) {
    return head(frame) + "<body>\n" + titleBar(frame) + "<main>\n" + content + "<footer>\n<p>" +
           escaped(frame.footer) + "</p>\n</footer>\n</main>\n" + "<script>/*<![CDATA[*/\n" +
           pageScript() + "/*]]>*/</script>\n</body>\n</html>\n";
}

} // namespace lodestone
