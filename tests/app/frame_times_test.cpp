#include "app/frame_times.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <thread>

namespace lodestone {
namespace {

void takeFrame(FrameTimes& times, FramePart slow_part, std::chrono::milliseconds time) {
    times.begin();
    for (const FramePart part :
         {FramePart::Session, FramePart::Interface, FramePart::Pictures, FramePart::Output}) {
        if (part == slow_part)
            std::this_thread::sleep_for(time);
        times.ended(part);
    }
}

TEST(FrameTimes, TellOnceASecondWhatTheSlowestFrameSpent) {
    FrameTimes times;
    takeFrame(times, FramePart::Pictures, std::chrono::milliseconds(5));
    const auto first = times.finish();
    ASSERT_TRUE(first);
    const auto told = nlohmann::json::parse("{" + *first + "}");
    EXPECT_EQ(told["count"], 1);
    EXPECT_GE(told["max_ms"], 5.0);
    const auto& slowest = told["slowest"];
    EXPECT_GE(slowest["pictures"], 5.0);
    double sum = 0.0;
    for (const FramePart part :
         {FramePart::Session, FramePart::Interface, FramePart::Pictures, FramePart::Output})
        sum += slowest[std::string(framePartName(part))].get<double>();
    EXPECT_NEAR(sum, told["max_ms"].get<double>(), 0.3) << "parts do not make up the frame";
    EXPECT_LT(slowest["worked"], slowest["pictures"]) << "sleeping is no work";
    takeFrame(times, FramePart::Output, std::chrono::milliseconds(1));
    EXPECT_FALSE(times.finish()) << "less than a second later";
}

TEST(FrameTimes, APartThatComesTwiceAddsUp) {
    FrameTimes times;
    times.begin();
    for (int pass = 0; pass < 2; ++pass) {
        std::this_thread::sleep_for(std::chrono::milliseconds(3));
        times.ended(FramePart::Interface);
    }
    const auto told = nlohmann::json::parse("{" + times.finish().value_or("") + "}");
    EXPECT_GE(told["slowest"]["interface"], 6.0);
}

} // namespace
} // namespace lodestone
