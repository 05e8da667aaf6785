#pragma once
// What lanes' pictures differ in from the original's, as pictures: FLIP of every pixel in the
// colours of a map, worked out beside the frames. Main thread, context current.
#include "app/color_map.h"
#include "app/session.h"
#include "render/background_work.h"
#include "render/picture_texture.h"
#include "render/view_set.h"

#include <map>
#include <optional>

namespace lodestone {

class PictureDifferences {
public:
    // Takes what is finished, tells the session the means, and goes on with the next lane whose
    // picture, or the reference's, or the map is another than before.
    void update(Session& session,
                const ViewSet& views,
                std::span<const ViewSet::Picture> pictures,
                const ViewSet::Picture& reference,
                ColorMap colors);
    void clear(Session& session); // nothing is to be shown

    struct Shown {
        TextureHandle texture = 0; // 0: none yet
        bool current = false;      // of the pictures of the last update()
    };

    Shown of(std::uint32_t lane) const;

    bool busy() const { return work_.has_value(); }

private:
    struct Source { // what a difference is made of
        std::uint64_t picture = 0;
        std::uint64_t reference = 0;
        ColorMap colors = ColorMap::Viridis;

        bool operator==(const Source&) const = default;
    };

    struct Entry {
        PictureTexture texture;
        Source made_of;
        Source wanted;
    };

    struct Task; // shared with the thread

    void collect(Session& session);
    void start(std::uint32_t lane, const Source& source, Pixels picture, Pixels reference);

    std::map<std::uint32_t, Entry> entries_;
    std::shared_ptr<Task> task_;
    std::optional<BackgroundWork> work_;
};

} // namespace lodestone
