#include "app/cli_progress.h"

#include <algorithm>
#include <fmt/core.h>
#include <ostream>

namespace lodestone {

namespace {

constexpr int kBarWidth = 30;
constexpr std::chrono::milliseconds kRedrawInterval{50};

} // namespace

ProgressBar::ProgressBar(const CliEnvironment& environment) : environment_(environment) {}

ProgressBar::~ProgressBar() {
    finish();
}

void ProgressBar::finish() {
    const std::lock_guard lock(mutex_);
    clear();
}

void ProgressBar::stage(std::string label) {
    const std::lock_guard lock(mutex_);
    label_ = std::move(label);
    draw(0.0);
}

JobContext ProgressBar::context() {
    JobContext context;
    context.stop = environment_.stop;
    if (environment_.show_progress)
        context.progress = [this](double fraction) {
            const std::lock_guard lock(mutex_);
            if (std::chrono::steady_clock::now() - drawn_ >= kRedrawInterval)
                draw(fraction);
        };
    return context;
}

void ProgressBar::draw(double fraction) {
    if (!environment_.show_progress)
        return;
    const double inside = std::clamp(fraction, 0.0, 1.0);
    const auto filled = static_cast<std::size_t>(inside * kBarWidth);
    environment_.err << fmt::format("\r\x1b[K{} [{}{}] {:3.0f} %",
                                    label_,
                                    std::string(filled, '#'),
                                    std::string(kBarWidth - filled, '.'),
                                    inside * 100.0)
                     << std::flush;
    drawn_ = std::chrono::steady_clock::now();
    visible_ = true;
}

void ProgressBar::clear() {
    if (visible_)
        environment_.err << "\r\x1b[K" << std::flush;
    visible_ = false;
}

} // namespace lodestone
