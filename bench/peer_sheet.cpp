#include "bench/peer_sheet.h"

#include "app/image_measure.h"
#include "app/main/headless_images.h"
#include "bench/peers/process.h"
#include "bench/peers/reduce_scene.h"
#include "scene/import.h"
#include "simplify/algorithm.h"
#include "simplify/measure/distance.h"

#include <cmath>
#include <fmt/core.h>
#include <limits>
#include <map>
#include <tbb/global_control.h>

namespace lodestone::bench {

namespace {

// Something to measure: one level of detail of the scene or of a scene read from a peer's file.
struct Column {
    ScenePtr scene;
    std::shared_ptr<const Lod> lod;
    Worth worth;
};

struct Contestant {
    PeerRow row;
    // One round: CPU seconds. Leaves its level of detail in `made`, the same in every round.
    std::function<Result<double>(Column& made)> run;
    std::vector<double> seconds; // [rounds]
    Column made;
};

std::uint64_t writtenBytes(const std::filesystem::path& path) {
    std::error_code missing;
    const std::uintmax_t bytes = std::filesystem::file_size(path, missing);
    return missing ? 0 : bytes;
}

// What is in a file is what is measured: writing one rounds.
Result<void> readBack(const std::filesystem::path& path, Column& column) {
    const Result<ScenePtr> read = importScene(path, {});
    if (!read)
        return tl::unexpected(read.error());
    column.scene = *read;
    column.lod = std::make_shared<const Lod>(fullLod(**read));
    column.worth.bytes = writtenBytes(path);
    return {};
}

// Writes a level of detail and reads it back.
Result<void> throughFile(const std::filesystem::path& path, Column& column) {
    column.worth.triangles = column.lod->triangles;
    column.worth.instances = column.lod->instances;
    const Result<ExportReport> written = exportScene(*column.scene, *column.lod, path, {});
    if (!written)
        return tl::unexpected(written.error());
    return readBack(path, column);
}

class SheetMaker {
public:
    SheetMaker(const PeerBench& bench, const ScenePtr& scene) : bench_(bench), scene_(scene) {}

    Result<PeerSheet> make(const std::string& input);

private:
    Result<void> prepareOurs();
    Result<void> writeInput();
    void addCallers();
    void addPrograms();
    Result<void> runRounds();
    Result<void> runOurs();
    Result<void> addOtherOrdering();
    // Our level of detail at as many triangles; made once each. Index into ours_.
    Result<std::size_t> oursAt(const LodSource& source, const Target& target);
    Result<void> measureAll();
    Result<void> measureDistances(std::span<Column* const> columns);
    void measurePictures(std::span<Column* const> columns);

    const PeerBench& bench_;
    ScenePtr scene_;
    const Algorithm* algorithm_ = nullptr;
    LodSourcePtr source_;
    ScratchFolder scratch_;
    PeerSheet sheet_;
    std::map<Welding, PeerInput> inputs_;
    std::vector<Contestant> contestants_;
    std::vector<Column> ours_; // the first one at the ratio
    std::map<std::pair<const LodSource*, std::uint64_t>, std::size_t> ours_at_;
    std::vector<double> our_seconds_;
    std::vector<double> our_program_seconds_;
};

Result<void> SheetMaker::prepareOurs() {
    const SceneCounts counts = countScene(*scene_);
    sheet_.triangles = counts.triangles;
    sheet_.unique_triangles = counts.unique_triangles;
    sheet_.instances = counts.instances;
    algorithm_ = findAlgorithm(counts.instances > counts.submeshes ? "ias" : "quadric");
    sheet_.ours_name = fmt::format("Lodestone {}", algorithm_->short_name);
    Result<LodSourcePtr> source = algorithm_->prepare(scene_, {}, {}, {});
    if (!source)
        return tl::unexpected(source.error());
    source_ = std::move(*source);
    return {};
}

// The file that programs read: one node an instance, which all of them understand.
Result<void> SheetMaker::writeInput() {
    ExportOptions options;
    options.instancing = Instancing::Nodes;
    const Result<ExportReport> written =
        exportScene(*scene_, fullLod(*scene_), scratch_.path() / "in.glb", options);
    return written ? Result<void>() : tl::unexpected(written.error());
}

void SheetMaker::addCallers() {
    for (const Welding welding : {Welding::AsStored, Welding::Positions})
        inputs_.try_emplace(welding, *scene_, welding, kPeerRatio);
    for (const MeshPeer& peer : bench_.meshes) {
        Contestant contestant;
        contestant.row.name = peer.name;
        contestant.run = [this, &peer](Column& made) -> Result<double> {
            Result<ReducedScene> reduced = inputs_.at(peer.welding).reduce(peer);
            if (!reduced)
                return tl::unexpected(reduced.error());
            made.scene = scene_;
            made.lod = std::make_shared<const Lod>(std::move(reduced->lod));
            return reduced->seconds;
        };
        contestants_.push_back(std::move(contestant));
    }
}

void SheetMaker::addPrograms() {
    for (const FilePeer& peer : bench_.files) {
        Contestant contestant;
        contestant.row.name = peer.name;
        contestant.row.kind = PeerKind::Program;
        contestant.run = [this, &peer](Column& made) -> Result<double> {
            const std::filesystem::path out = scratch_.path() / "out.glb";
            Result<double> seconds = peer.run(scratch_.path() / "in.glb", out);
            if (!seconds || made.scene)
                return seconds;
            if (const Result<void> read = readBack(out, made); !read)
                return tl::unexpected(read.error());
            made.worth.triangles = made.lod->triangles;
            made.worth.instances = made.lod->instances;
            return seconds;
        };
        contestants_.push_back(std::move(contestant));
    }
}

Result<void> SheetMaker::runOurs() {
    const double start = cpuSeconds();
    const Result<LodSourcePtr> source = algorithm_->prepare(scene_, {}, {}, {});
    if (!source)
        return tl::unexpected(source.error());
    const ByteModel bytes((*source)->scene(), ExportOptions{});
    const double bytes_made = cpuSeconds(); // only a target in bytes needs it
    const Resolved at = (*source)->resolve({Target::Kind::Ratio, kPeerRatio}, bytes);
    const Lod lod = (*source)->readOut(at.position, nullptr);
    const double read_out = cpuSeconds() - bytes_made;
    our_seconds_.push_back(read_out + bytes_made - start);
    if (bench_.lodestone.empty())
        return {};
    const Result<Ran> ran = runProgram({bench_.lodestone,
                                        "simplify",
                                        (scratch_.path() / "in.glb").string(),
                                        "-o",
                                        (scratch_.path() / "ours.glb").string(),
                                        "--algorithm",
                                        std::string(algorithm_->id),
                                        "--ratio",
                                        fmt::format("{}", kPeerRatio)});
    if (!ran)
        return tl::unexpected(ran.error());
    our_program_seconds_.push_back(ran->seconds);
    return {};
}

Result<void> SheetMaker::runRounds() {
    const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
    for (int round = 0; round < bench_.rounds; ++round) {
        Result<void> ours = runOurs();
        if (!ours)
            return ours;
        for (Contestant& contestant : contestants_) {
            if (!contestant.row.failure.empty())
                continue;
            const Result<double> seconds = contestant.run(contestant.made);
            if (seconds)
                contestant.seconds.push_back(*seconds);
            else
                contestant.row.failure = seconds.error().message;
        }
    }
    return {};
}

// The same sequences by bytes: another way of ours, which makes the smaller files.
Result<void> SheetMaker::addOtherOrdering() {
    if (sheet_.instances == scene_->submeshes.size())
        return {};
    const ByteModel bytes(source_->scene(), ExportOptions{});
    const LodSourcePtr by_bytes = source_->rescheduled({Ordering::Byte, {}, {}}, bytes);
    const Result<std::size_t> at = oursAt(*by_bytes, {Target::Kind::Ratio, kPeerRatio});
    if (!at)
        return tl::unexpected(at.error());
    Contestant contestant;
    contestant.row.name = sheet_.ours_name + ", ordering byte";
    contestant.row.kind = PeerKind::Ours;
    contestant.made = ours_[*at];
    contestants_.insert(contestants_.begin(), std::move(contestant));
    return {};
}

Result<std::size_t> SheetMaker::oursAt(const LodSource& source, const Target& target) {
    const ByteModel bytes(source.scene(), ExportOptions{});
    const Resolved resolved = source.resolve(target, bytes);
    const auto [known, added] = ours_at_.try_emplace({&source, resolved.position}, ours_.size());
    if (!added)
        return known->second;
    Column& made = ours_.emplace_back();
    made.scene = source.scene();
    made.lod = std::make_shared<const Lod>(source.readOut(resolved.position, nullptr));
    if (const Result<void> read = throughFile(scratch_.path() / "ours.glb", made); !read)
        return tl::unexpected(read.error());
    ++sheet_.files_of_ours;
    made.worth.predicted_bytes = bytes.bytes(source.shapeAt(resolved.position));
    if (made.worth.predicted_bytes == made.worth.bytes)
        ++sheet_.files_as_predicted;
    return known->second;
}

Result<void> SheetMaker::measureDistances(std::span<Column* const> columns) {
    const Lod full = fullLod(*scene_);
    for (Column* column : columns) {
        const Result<Distance> distance = measureDistance(
            {scene_.get(), &full}, {column->scene.get(), column->lod.get()}, {bench_.samples}, {});
        if (!distance)
            return tl::unexpected(distance.error());
        column->worth.maximum = distance->hausdorff;
        column->worth.mean = distance->mean;
    }
    return {};
}

void SheetMaker::measurePictures(std::span<Column* const> columns) {
    std::vector<ImageColumn> images{
        {scene_, std::make_shared<const Lod>(fullLod(*scene_)), "original"}};
    for (const Column* column : columns)
        images.push_back({column->scene, column->lod, ""});
    ImageMeasureOptions options;
    options.size_px = bench_.picture_px;
    const std::unique_ptr<ImageSource> source = makeHeadlessImages();
    const Result<std::vector<ImageDifference>> differences =
        measureImages(*source, images, options, {});
    if (!differences)
        sheet_.picture_failure = differences.error().message;
    for (std::size_t i = 0; i < columns.size(); ++i)
        columns[i]->worth.flip =
            differences ? (*differences)[i].flip : std::numeric_limits<double>::quiet_NaN();
}

Result<void> SheetMaker::measureAll() {
    std::vector<std::size_t> rivals(contestants_.size()); // of ours
    for (std::size_t i = 0; i < contestants_.size(); ++i) {
        Contestant& contestant = contestants_[i];
        if (contestant.row.failure.empty() && contestant.made.lod->triangles == 0)
            contestant.row.failure = "nothing is left of the scene";
        if (!contestant.row.failure.empty())
            continue;
        if (contestant.row.kind == PeerKind::Call)
            if (const Result<void> read =
                    throughFile(scratch_.path() / "peer.glb", contestant.made);
                !read)
                contestant.row.failure = read.error().message;
        const auto triangles = static_cast<double>(contestant.made.worth.triangles);
        const Result<std::size_t> at = oursAt(*source_, {Target::Kind::Triangles, triangles});
        if (!at)
            return tl::unexpected(at.error());
        rivals[i] = *at;
    }
    std::vector<Column*> columns;
    for (Column& column : ours_)
        columns.push_back(&column);
    for (Contestant& contestant : contestants_)
        if (contestant.row.failure.empty())
            columns.push_back(&contestant.made);
    Result<void> measured = measureDistances(columns);
    if (!measured)
        return measured;
    measurePictures(columns);
    for (std::size_t i = 0; i < contestants_.size(); ++i) {
        contestants_[i].row.theirs = contestants_[i].made.worth;
        contestants_[i].row.ours = ours_[rivals[i]].worth;
    }
    return {};
}

Result<PeerSheet> SheetMaker::make(const std::string& input) {
    sheet_.input = input;
    Result<void> done = prepareOurs();
    if (done)
        done = writeInput();
    addCallers();
    addPrograms();
    if (done)
        done = runRounds();
    if (!done)
        return tl::unexpected(done.error());
    const Result<std::size_t> at_ratio = oursAt(*source_, {Target::Kind::Ratio, kPeerRatio});
    if (!at_ratio)
        return tl::unexpected(at_ratio.error());
    done = addOtherOrdering();
    if (done)
        done = measureAll();
    if (!done)
        return tl::unexpected(done.error());
    sheet_.our_seconds = spreadOf(our_seconds_);
    if (!our_program_seconds_.empty())
        sheet_.our_program_seconds = spreadOf(our_program_seconds_);
    sheet_.ours = ours_.front().worth;
    for (Contestant& contestant : contestants_) {
        const bool program = contestant.row.kind == PeerKind::Program;
        const std::vector<double>& base = program ? our_program_seconds_ : our_seconds_;
        contestant.row.time_ratio = std::numeric_limits<double>::quiet_NaN();
        if (contestant.row.failure.empty() && !contestant.seconds.empty()) {
            contestant.row.seconds = spreadOf(contestant.seconds);
            if (!base.empty())
                contestant.row.time_ratio = medianRatio(contestant.seconds, base);
        }
        sheet_.rows.push_back(std::move(contestant.row));
    }
    return std::move(sheet_);
}

} // namespace

Result<PeerSheet>
measurePeers(const PeerBench& bench, const std::string& input, const ScenePtr& scene) {
    return SheetMaker(bench, scene).make(input);
}

} // namespace lodestone::bench
