#include "ui/texture_section.h"

#include "app/texture_jobs.h"
#include "ui/format.h"
#include "ui/parameter_control.h"
#include "ui/widgets.h"

#include <algorithm>
#include <array>
#include <cstdio>

namespace lodestone::ui {

namespace {

constexpr std::string_view kTexture = "texture";

std::string densityText(double texels_per_unit) {
    char number[32] = "";
    std::snprintf(number, sizeof number, "%.4g", texels_per_unit);
    return number;
}

// "0.81× original"
std::string relativeText(double texels_per_unit, double original_texels_per_unit) {
    if (original_texels_per_unit <= 0.0)
        return {};
    char number[48] = "";
    std::snprintf(
        number, sizeof number, "%.2f\u00d7 original", texels_per_unit / original_texels_per_unit);
    return number;
}

void keepOrTransfer(const Ui& ui, const Lane& lane) {
    constexpr std::array<std::string_view, 2> kItems = {"keep UVs", "transfer"};
    constexpr std::array<std::string_view, 2> kTips = {
        "Levels keep the texture coordinates and the textures of the file.",
        "Every triangle of the level gets texels of its own in a new atlas, painted with what the "
        "original shows there. Made in the background whenever the level changes."};
    const bool transfers = wantedTextures(lane.settings).has_value();
    const float width = ImGui::GetContentRegionAvail().x;
    const auto chosen = segmented(ui, {"Textures", kItems, transfers ? 1 : 0, kTips, width});
    if (chosen)
        ui.push(SetLaneParameter{lane.id, std::string(kTexture), static_cast<double>(*chosen)});
}

// A picture that fills a square, its shape kept; a word in its place where there is none.
void drawSquare(const Ui& ui,
                const PanelInput& input,
                const LaneTexturesPtr& textures,
                const ImagePreview& preview,
                const ImVec2& min,
                float side) {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const ImVec2 max = min + ImVec2(side, side);
    list.AddRectFilled(min, max, color::kView);
    const ImTextureID picture =
        input.facts.preview && !preview.empty() ? input.facts.preview(textures, preview) : nullptr;
    if (!picture) {
        drawText(ui,
                 min + ImVec2(side * 0.5f, side * 0.5f - ImGui::GetTextLineHeight() * 0.5f),
                 Align::Center,
                 "no texture",
                 {ui.theme.fonts.small, color::kFaint});
        return;
    }
    const auto longest = static_cast<float>(std::max(preview.width, preview.height));
    const ImVec2 size{side * static_cast<float>(preview.width) / longest,
                      side * static_cast<float>(preview.height) / longest};
    const ImVec2 begin = min + ImVec2((side - size.x) * 0.5f, (side - size.y) * 0.5f);
    list.AddImage(picture, begin, begin + size, {0, 1}, {1, 0});
}

void caption(const Ui& ui, const ImVec2& at, float width, std::string_view name, std::uint32_t px) {
    const std::string text =
        px > 0 ? std::string(name) + " \u00b7 " + formatCount(px) + " px" : std::string(name);
    ImFont* const small = ui.theme.fonts.small;
    drawText(ui, at, Align::Left, fitText(ui, text, width, small), {small, color::kSecondary});
}

// Both pictures of a pair with their captions, side by side.
void drawPair(const Ui& ui,
              const PanelInput& input,
              const LaneTexturesPtr& textures,
              const AtlasPreview& pair,
              float side) {
    const ImVec2 left = ImGui::GetCursorScreenPos();
    const ImVec2 right = left + ImVec2(side + ui.px(8), 0);
    drawSquare(ui, input, textures, pair.before, left, side);
    drawSquare(ui, input, textures, pair.after, right, side);
    const ImVec2 below(0, side + ui.px(3));
    caption(ui, left + below, side, "original", pair.before_px);
    caption(ui, right + below, side, "atlas", pair.after_px);
}

void drawProgress(const Ui& ui, double progress) {
    labelledValue(ui, "Transferring", std::to_string(static_cast<int>(progress * 100.0)) + " %");
}

void drawFailure(const Ui& ui, const Lane& lane) {
    ImGui::PushTextWrapPos(0.0f);
    ImGui::PushStyleColor(ImGuiCol_Text, color::kWarning);
    ImGui::TextUnformatted(("Not transferred: " + lane.status.texture_failure).c_str());
    ImGui::PopStyleColor();
    ImGui::PopTextWrapPos();
    if (linkButton(ui, "Transfer again", color::kAccent))
        ui.push(RetryLane{lane.id});
}

// How fine the texels are, or how far newer ones have come, and the first pair small.
void drawResult(const Ui& ui, const PanelInput& input, WindowState& state, const Lane& lane) {
    const LaneTexturesPtr& textures = lane.status.textures;
    if (textures->previews.empty()) {
        ImGui::TextDisabled("No new atlas was needed.");
        return;
    }
    const std::vector<BakedAtlas>& atlases = textures->baked.atlases;
    const auto coarsest = std::ranges::min_element(atlases, {}, &BakedAtlas::texels_per_unit);
    if (lane.status.texture_progress)
        drawProgress(ui, *lane.status.texture_progress);
    else if (coarsest != atlases.end())
        labelledValue(ui,
                      "Texels a unit",
                      densityText(coarsest->texels_per_unit),
                      relativeText(coarsest->texels_per_unit, coarsest->original_texels_per_unit));
    const float side = (ImGui::GetContentRegionAvail().x - ui.px(8)) * 0.5f;
    const ImVec2 begin = ImGui::GetCursorScreenPos();
    drawPair(ui, input, textures, textures->previews.front(), side);
    ImGui::SetCursorScreenPos(begin);
    if (ImGui::InvisibleButton("atlas", {2 * side + ui.px(8), side + ui.px(20)})) {
        state.shown_atlas = 0;
        state.open(Dialog::Textures);
    }
    ui.record("atlas");
    tooltip(ui, "The texture before and the atlas after the transfer. Click to enlarge.");
}

} // namespace

void drawTextureSection(const Ui& ui,
                        const PanelInput& input,
                        WindowState& state,
                        const Lane& lane) {
    const std::vector<ParameterInfo>& parameters = lane.settings.algorithm->parameters;
    if (std::ranges::find(parameters, kTexture, &ParameterInfo::id) == parameters.end())
        return;
    drawText(
        ui, ImGui::GetCursorScreenPos(), Align::Left, "Textures", {nullptr, color::kSecondary});
    ImGui::Dummy({0, ImGui::GetTextLineHeight() + ui.px(2)});
    keepOrTransfer(ui, lane);
    if (!lane.status.texture_failure.empty())
        drawFailure(ui, lane);
    if (lane.status.textures)
        drawResult(ui, input, state, lane);
    else if (lane.status.texture_progress)
        drawProgress(ui, *lane.status.texture_progress);
    for (const ParameterInfo& parameter : parameters)
        if (parameter.of_textures && parameter.id != kTexture)
            parameterControl(ui, lane, parameter);
}

DialogStep drawTexturePair(const Ui& ui, const PanelInput& input, WindowState& state) {
    const Lane* const lane = input.document.findLane(input.document.active_lane);
    const LaneTexturesPtr textures = lane ? lane->status.textures : nullptr;
    if (!textures || textures->previews.empty())
        return DialogStep::Close;
    const auto last = static_cast<int>(textures->previews.size()) - 1;
    state.shown_atlas = std::clamp(state.shown_atlas, 0, last);
    const AtlasPreview& pair = textures->previews[static_cast<std::size_t>(state.shown_atlas)];
    const ImVec2 display = ImGui::GetIO().DisplaySize;
    const float side =
        std::max(ui.px(120), std::min((display.x - ui.px(120)) * 0.5f, display.y - ui.px(230)));
    const std::string name = pair.name.empty() ? "material without a name" : pair.name;
    std::string facts = densityText(pair.texels_per_unit) + " texels a unit";
    const std::string relative = relativeText(pair.texels_per_unit, pair.original_texels_per_unit);
    if (!relative.empty())
        facts += " \u00b7 " + relative;
    const ImVec2 begin = ImGui::GetCursorScreenPos();
    drawText(ui, begin, Align::Left, fitText(ui, name, side), {ui.theme.fonts.semibold});
    drawText(ui,
             begin + ImVec2(2 * side + ui.px(8), 0),
             Align::Right,
             facts,
             {nullptr, color::kSecondary});
    ImGui::Dummy({2 * side + ui.px(8), ui.px(22)});
    drawPair(ui, input, textures, pair, side);
    ImGui::Dummy({2 * side + ui.px(8), side + ui.px(22)});
    ui.record("pair");
    const bool closes = button(ui, "Close", ui.px(92));
    if (last > 0) {
        ImGui::SameLine();
        if (button(ui, "Previous", ui.px(92)))
            state.shown_atlas = state.shown_atlas > 0 ? state.shown_atlas - 1 : last;
        ImGui::SameLine();
        if (button(ui, "Next", ui.px(92)))
            state.shown_atlas = state.shown_atlas < last ? state.shown_atlas + 1 : 0;
        ImGui::SameLine();
        ImGui::TextDisabled("%d of %d", state.shown_atlas + 1, last + 1);
    }
    return closes ? DialogStep::Close : DialogStep::Stay;
}

} // namespace lodestone::ui
