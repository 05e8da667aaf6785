#pragma once
// Size over triangles of every lane, for the chart: computed on a thread of its own, because a
// prediction for a scene of many nodes takes longer than a frame. Newest wins.
#include "app/document.h"

#include <atomic>
#include <memory>
#include <thread>
#include <vector>

namespace lodestone::ui {

struct SizePoint {
    double ratio = 0.0; // of the original's triangles
    double size_bytes = 0.0;
    double error_rel_percent = 0.0; // estimated, of the diagonal
};

using SizeCurve = std::vector<SizePoint>; // by rising ratio

class SizeCurves {
public:
    // Starts what is missing for the document's ready lanes and takes what is finished.
    // Returns whether a curve changed. Main thread.
    bool update(const Document& document);

    // Empty while it is not known.
    const SizeCurve& of(LaneId lane) const;

    bool busy() const { return task_ != nullptr; }

private:
    struct Key {
        LaneId lane = kNoLane;
        LodSourcePtr source;
        ExportOptions options;
        std::size_t point_count = 0; // of the curve

        bool matches(const Key& other) const;
    };

    struct Task {
        Key key;
        SizeCurve curve;
        std::atomic<bool> done = false;
    };

    struct Known {
        Key key;
        SizeCurve curve;
    };

    void start(Key key, std::uint64_t original_triangles);
    bool collect();

    std::vector<Known> known_;
    std::shared_ptr<Task> task_; // one at a time
    std::jthread thread_;
};

} // namespace lodestone::ui
