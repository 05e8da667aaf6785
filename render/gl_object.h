#pragma once
// Move-only owners of GL names. Made and destroyed with the context current.
#include "render/gl.h"

#include <utility>

namespace lodestone {

template <class Traits>
class GlObject {
public:
    GlObject() = default;

    explicit GlObject(GLuint name) : name_(name) {}

    ~GlObject() { reset(); }

    GlObject(GlObject&& other) noexcept : name_(std::exchange(other.name_, 0)) {}

    GlObject& operator=(GlObject&& other) noexcept {
        if (this != &other) {
            reset();
            name_ = std::exchange(other.name_, 0);
        }
        return *this;
    }

    static GlObject create() { return GlObject(Traits::create()); }

    GLuint name() const { return name_; }

    explicit operator bool() const { return name_ != 0; }

    void reset() {
        if (name_ != 0)
            Traits::destroy(std::exchange(name_, 0));
    }

private:
    GLuint name_ = 0;
};

struct GlBufferTraits {
    static GLuint create() {
        GLuint name = 0;
        glGenBuffers(1, &name);
        return name;
    }

    static void destroy(GLuint name) { glDeleteBuffers(1, &name); }
};

struct GlVertexArrayTraits {
    static GLuint create() {
        GLuint name = 0;
        glGenVertexArrays(1, &name);
        return name;
    }

    static void destroy(GLuint name) { glDeleteVertexArrays(1, &name); }
};

struct GlTextureTraits {
    static GLuint create() {
        GLuint name = 0;
        glGenTextures(1, &name);
        return name;
    }

    static void destroy(GLuint name) { glDeleteTextures(1, &name); }
};

struct GlSamplerTraits {
    static GLuint create() {
        GLuint name = 0;
        glGenSamplers(1, &name);
        return name;
    }

    static void destroy(GLuint name) { glDeleteSamplers(1, &name); }
};

struct GlRenderbufferTraits {
    static GLuint create() {
        GLuint name = 0;
        glGenRenderbuffers(1, &name);
        return name;
    }

    static void destroy(GLuint name) { glDeleteRenderbuffers(1, &name); }
};

struct GlFramebufferTraits {
    static GLuint create() {
        GLuint name = 0;
        glGenFramebuffers(1, &name);
        return name;
    }

    static void destroy(GLuint name) { glDeleteFramebuffers(1, &name); }
};

struct GlQueryTraits {
    static GLuint create() {
        GLuint name = 0;
        glGenQueries(1, &name);
        return name;
    }

    static void destroy(GLuint name) { glDeleteQueries(1, &name); }
};

struct GlProgramTraits {
    static GLuint create() { return glCreateProgram(); }

    static void destroy(GLuint name) { glDeleteProgram(name); }
};

struct GlShaderTraits {
    static void destroy(GLuint name) { glDeleteShader(name); }
};

using GlBuffer = GlObject<GlBufferTraits>;
using GlVertexArray = GlObject<GlVertexArrayTraits>;
using GlTexture = GlObject<GlTextureTraits>;
using GlSampler = GlObject<GlSamplerTraits>;
using GlRenderbuffer = GlObject<GlRenderbufferTraits>;
using GlFramebuffer = GlObject<GlFramebufferTraits>;
using GlQuery = GlObject<GlQueryTraits>;
using GlProgram = GlObject<GlProgramTraits>;
using GlShader = GlObject<GlShaderTraits>;

} // namespace lodestone
