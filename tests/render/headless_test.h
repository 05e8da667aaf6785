#pragma once
#include "render/gl_context.h"

#include <cstdlib>
#include <gtest/gtest.h>
#include <memory>
#include <string_view>

namespace lodestone::tests {

// A test that draws without a display: skipped where there is no EGL, failed there when CI=true,
// so that the pictures are never silently untested. A SetUp of its own calls this one first and
// returns where it left context_ null.
class HeadlessTest : public ::testing::Test {
protected:
    void SetUp() override {
        Result<std::unique_ptr<GlContext>> context = createHeadlessContext();
        if (context) {
            context_ = std::move(*context);
            return;
        }
        const char* ci = std::getenv("CI");
        if (ci != nullptr && std::string_view(ci) == "true")
            FAIL() << context.error().message;
        GTEST_SKIP() << "no EGL: " << context.error().message;
    }

    std::unique_ptr<GlContext> context_;
};

} // namespace lodestone::tests
