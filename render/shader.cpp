#include "render/shader.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <vector>

namespace lodestone {

namespace {

constexpr std::string_view kCommonFile = "common.glsl";

Result<std::string> shaderText(std::string_view name) {
    if (const char* folder = std::getenv("LODESTONE_SHADER_DIR"); folder && *folder != '\0') {
        const std::filesystem::path path = std::filesystem::path(folder) / name;
        std::ifstream file(path, std::ios::binary);
        if (!file)
            return badInput("shader '" + path.string() +
                            "' cannot be read; unset LODESTONE_SHADER_DIR or add the file");
        return std::string(std::istreambuf_iterator<char>(file), {});
    }
    for (const ShaderText& shader : kShaderTexts)
        if (shader.name == name)
            return std::string(shader.text);
    return fail(ErrorKind::Failed, "shader '" + std::string(name) + "' is not part of the program");
}

// First line of a driver's log as "shaders/FILE:LINE: message". Drivers write "1:12(5): error",
// "1(12) : error" or "ERROR: 1:12:"; the first number is the string, the second the line.
std::string readableLog(const std::string& log, std::string_view file) {
    static const std::regex kPlace(R"((?:ERROR: )?(\d+)[:(](\d+)\)?(?:\(\d+\))?\s*:?\s*([^\n]*))");
    std::smatch match;
    if (std::regex_search(log, match, kPlace)) {
        const std::string name(match[1].str() == "0" ? kCommonFile : file);
        return "shaders/" + name + ":" + match[2].str() + ": " + match[3].str();
    }
    return "shaders/" + std::string(file) + ": " + log.substr(0, log.find('\n'));
}

std::string shaderLog(GLuint shader) {
    GLint length = 0;
    glGetShaderiv(shader, GL_INFO_LOG_LENGTH, &length);
    std::string log(static_cast<std::size_t>(length > 0 ? length : 0), '\0');
    if (length > 0)
        glGetShaderInfoLog(shader, length, nullptr, log.data());
    return log;
}

Result<GlShader>
compileStage(GLenum stage, std::string_view file, std::span<const std::string_view> defines) {
    const Result<std::string> common = shaderText(kCommonFile);
    if (!common)
        return tl::unexpected(common.error());
    const Result<std::string> body = shaderText(file);
    if (!body)
        return tl::unexpected(body.error());
    std::string text = "#version 330 core\n";
    for (const std::string_view define : defines)
        text += "#define " + std::string(define) + " 1\n";
    if (!file.starts_with("background"))
        text += "#line 1 0\n" + *common;
    text += "#line 1 1\n" + *body;

    GlShader shader(glCreateShader(stage));
    const char* source = text.c_str();
    glShaderSource(shader.name(), 1, &source, nullptr);
    glCompileShader(shader.name());
    GLint compiled = GL_FALSE;
    glGetShaderiv(shader.name(), GL_COMPILE_STATUS, &compiled);
    if (compiled != GL_TRUE)
        return fail(ErrorKind::Failed, readableLog(shaderLog(shader.name()), file));
    return shader;
}

std::string programLog(GLuint program) {
    GLint length = 0;
    glGetProgramiv(program, GL_INFO_LOG_LENGTH, &length);
    std::string log(static_cast<std::size_t>(length > 0 ? length : 0), '\0');
    if (length > 0)
        glGetProgramInfoLog(program, length, nullptr, log.data());
    return log.substr(0, log.find('\n'));
}

} // namespace

Result<GlProgram> buildProgram(const ProgramFiles& files,
                               std::span<const std::string_view> defines) {
    struct Stage {
        GLenum kind;
        std::string_view file;
    };

    GlProgram program = GlProgram::create();
    std::vector<GlShader> shaders;
    for (const Stage& stage : {Stage{GL_VERTEX_SHADER, files.vertex},
                               Stage{GL_GEOMETRY_SHADER, files.geometry},
                               Stage{GL_FRAGMENT_SHADER, files.fragment}}) {
        if (stage.file.empty())
            continue;
        Result<GlShader> shader = compileStage(stage.kind, stage.file, defines);
        if (!shader)
            return tl::unexpected(shader.error());
        glAttachShader(program.name(), shader->name());
        shaders.push_back(std::move(*shader));
    }
    glLinkProgram(program.name());
    GLint linked = GL_FALSE;
    glGetProgramiv(program.name(), GL_LINK_STATUS, &linked);
    if (linked != GL_TRUE)
        return fail(ErrorKind::Failed,
                    "shaders/" + std::string(files.vertex) + " + " + std::string(files.fragment) +
                        " do not link: " + programLog(program.name()));
    for (const GlShader& shader : shaders)
        glDetachShader(program.name(), shader.name());
    return program;
}

} // namespace lodestone
