/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file draws.c
 * Draws that know nothing of the k-buffer, in many states of the fragment
 * pipeline, in a surfaceless EGL context.  ../stock-identity runs it on stock
 * and on patched Mesa with GALLIVM_DEBUG=ir and compares what is generated.
 *
 * Prints a checksum of the pixels of each case.  With the argument `mutate`
 * one blend factor is another: the comparison has to see that.
 */

#include "context.h"
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#define W 32

static bool mutate;

/** A framebuffer of textures (samples 0) or renderbuffers. */
static void
make_framebuffer(GLenum format, int attachments, int samples, GLenum depth)
{
	GLenum buffers[8];
	GLuint fbo, rb;

	glGenFramebuffers(1, &fbo);
	glBindFramebuffer(GL_FRAMEBUFFER, fbo);
	for (int i = 0; i <= attachments; i++) {
		const bool z = i == attachments;

		if (z && !depth)
			break;
		glGenRenderbuffers(1, &rb);
		glBindRenderbuffer(GL_RENDERBUFFER, rb);
		glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples,
						 z ? depth : format, W, W);
		if (!z)
			buffers[i] = GL_COLOR_ATTACHMENT0 + i;
		glFramebufferRenderbuffer(GL_FRAMEBUFFER, !z ? buffers[i] :
					  depth == GL_DEPTH24_STENCIL8 ?
					  GL_DEPTH_STENCIL_ATTACHMENT :
					  GL_DEPTH_ATTACHMENT,
					  GL_RENDERBUFFER, rb);
	}
	glDrawBuffers(attachments, buffers);
	if (glCheckFramebufferStatus(GL_FRAMEBUFFER) !=
	    GL_FRAMEBUFFER_COMPLETE)
		die("incomplete framebuffer");
	glViewport(0, 0, W, W);
	glClearColor(.1, .2, .3, .4);
	glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT |
		GL_STENCIL_BUFFER_BIT);
}

static void
draw(void)
{
	glBegin(GL_TRIANGLES);
	glColor4f(1, .5, .25, .75);
	glTexCoord2f(0, 0);
	glVertex3f(-1, -1, -.5);
	glColor4f(.25, 1, .5, .5);
	glTexCoord2f(2, 0);
	glVertex3f(3, -1, .25);
	glColor4f(.5, .25, 1, .25);
	glTexCoord2f(0, 2);
	glVertex3f(-1, 3, .5);
	glEnd();
}

/** The pixels of color attachment 0, resolved where that is needed. */
static void
print_checksum(const char *name)
{
	float pixels[W * W * 4];
	uint64_t hash = 0xcbf29ce484222325;
	GLuint fbo, rb;

	glDisable(GL_SCISSOR_TEST);
	glGenFramebuffers(1, &fbo);
	glGenRenderbuffers(1, &rb);
	glBindRenderbuffer(GL_RENDERBUFFER, rb);
	glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA32F, W, W);
	glBindFramebuffer(GL_DRAW_FRAMEBUFFER, fbo);
	glFramebufferRenderbuffer(GL_DRAW_FRAMEBUFFER, GL_COLOR_ATTACHMENT0,
				  GL_RENDERBUFFER, rb);
	glBlitFramebuffer(0, 0, W, W, 0, 0, W, W, GL_COLOR_BUFFER_BIT,
			  GL_NEAREST);
	glBindFramebuffer(GL_FRAMEBUFFER, fbo);
	glReadPixels(0, 0, W, W, GL_RGBA, GL_FLOAT, pixels);
	for (size_t i = 0; i < sizeof(pixels); i++)
		hash = (hash ^ ((uint8_t *)pixels)[i]) * 0x100000001b3;
	if (glGetError() != GL_NO_ERROR)
		die(name);
	printf("%s %016llx\n", name, (unsigned long long)hash);
}

static void
begin(void)
{
	glPushAttrib(GL_ALL_ATTRIB_BITS);
}

static void
end(const char *name)
{
	draw();
	print_checksum(name);
	glUseProgram(0);
	glPopAttrib();
}

static void
use_texture(GLenum format, GLenum filter)
{
	float texels[8 * 8 * 4];
	GLuint tex;

	for (int i = 0; i < 8 * 8 * 4; i++)
		texels[i] = i * 37 % 256 / 255.0;
	glGenTextures(1, &tex);
	glBindTexture(GL_TEXTURE_2D, tex);
	glTexImage2D(GL_TEXTURE_2D, 0, format, 8, 8, 0, GL_RGBA, GL_FLOAT,
		     texels);
	glGenerateMipmap(GL_TEXTURE_2D);
	glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, filter);
	glEnable(GL_TEXTURE_2D);
}

static void
use_glsl(const char *fs)
{
	static const char *vs = "#version 130\nout vec2 uv;\n"
		"void main() { gl_Position = gl_Vertex; "
		"uv = gl_MultiTexCoord0.xy; gl_FrontColor = gl_Color; }\n";
	GLuint program = glCreateProgram(), shader;
	GLint ok;

	for (int i = 0; i < 2; i++) {
		shader = glCreateShader(i ? GL_FRAGMENT_SHADER :
					GL_VERTEX_SHADER);
		glShaderSource(shader, 1, i ? &fs : &vs, NULL);
		glCompileShader(shader);
		glAttachShader(program, shader);
	}
	glLinkProgram(program);
	glGetProgramiv(program, GL_LINK_STATUS, &ok);
	if (!ok)
		die("a shader does not link");
	glUseProgram(program);
}

static void
blending(void)
{
	static const GLenum formats[] = {
		GL_RGBA8, GL_RGBA16, GL_RGBA16F, GL_RGBA32F, GL_SRGB8_ALPHA8,
		GL_RGB565, GL_R11F_G11F_B10F, GL_RGB10_A2, GL_R8,
	};
	static const GLenum factors[][2] = {
		{ GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA }, { GL_ONE, GL_ONE },
		{ GL_DST_COLOR, GL_ZERO },
	};
	char name[64];

	for (int f = 0; f < 9; f++) {
		for (int b = 0; b < 3; b++) {
			begin();
			make_framebuffer(formats[f], 1, 0, GL_NONE);
			glEnable(GL_FRAMEBUFFER_SRGB);
			glEnable(GL_BLEND);
			glBlendFunc(factors[b][0], mutate && f == 0 && b == 1 ?
				    GL_SRC_ALPHA : factors[b][1]);
			snprintf(name, sizeof(name), "blend-%#x-%d",
				 formats[f], b);
			end(name);
		}
	}
}

static void
tests(void)
{
	static const GLenum depths[] = { GL_DEPTH24_STENCIL8,
		GL_DEPTH_COMPONENT16, GL_DEPTH_COMPONENT32F };

	for (int d = 0; d < 3; d++) {
		for (int samples = 0; samples <= 4; samples += 4) {
			char name[64];

			begin();
			make_framebuffer(GL_RGBA8, 1, samples, depths[d]);
			glEnable(GL_DEPTH_TEST);
			glDepthFunc(GL_LEQUAL);
			if (d == 0) {
				glEnable(GL_STENCIL_TEST);
				glStencilFunc(GL_GEQUAL, 0, 255);
				glStencilOp(GL_KEEP, GL_INCR, GL_DECR_WRAP);
			}
			draw();
			glEnable(GL_ALPHA_TEST);
			glAlphaFunc(GL_GREATER, .5);
			glEnable(GL_POLYGON_OFFSET_FILL);
			glPolygonOffset(1, 1);
			snprintf(name, sizeof(name), "depth-%#x-%d", depths[d],
				 samples);
			end(name);
		}
	}
	begin();
	make_framebuffer(GL_RGBA8, 1, 4, GL_NONE);
	glEnable(GL_SAMPLE_ALPHA_TO_COVERAGE);
	glEnable(GL_SAMPLE_ALPHA_TO_ONE);
	glEnable(GL_BLEND);
	glBlendFunc(GL_SRC_ALPHA, GL_ONE);
	end("alpha-to-coverage");
	begin();
	make_framebuffer(GL_RGBA8, 1, 0, GL_NONE);
	glEnable(GL_COLOR_LOGIC_OP);
	glLogicOp(GL_XOR);
	glColorMask(1, 0, 1, 1);
	end("logic-op");
}

static void
shaders(void)
{
	begin();
	make_framebuffer(GL_RGBA8, 4, 0, GL_NONE);
	glEnablei(GL_BLEND, 2);
	glBlendFunc(GL_ONE, GL_SRC_ALPHA);
	glColorMaski(1, 1, 0, 0, 1);
	use_glsl("#version 130\nin vec2 uv;\nvoid main() {\n"
		 "if (uv.x > 1.5) discard;\n"
		 "for (int i = 0; i < 4; i++) "
		 "gl_FragData[i] = gl_Color * (0.25 * float(i + 1)); }\n");
	end("multiple-targets");

	begin();
	make_framebuffer(GL_RGBA32F, 1, 0, GL_DEPTH_COMPONENT32F);
	glEnable(GL_DEPTH_TEST);
	use_glsl("#version 130\nin vec2 uv;\nvoid main() {\n"
		 "gl_FragDepth = fract(uv.x * 3.0);\n"
		 "gl_FragColor = gl_FragCoord * dFdx(uv.x); }\n");
	end("written-depth");

	begin();
	make_framebuffer(GL_RGBA8UI, 1, 0, GL_NONE);
	glClearBufferuiv(GL_COLOR, 0, (GLuint[4]) { 1, 2, 3, 4 });
	use_glsl("#version 130\nout uvec4 o;\n"
		 "void main() { o = uvec4(gl_FragCoord.xyxy); }\n");
	draw();
	glUseProgram(0);
	glPopAttrib();

	for (int i = 0; i < 4; i++) {
		static const GLenum filters[] = { GL_NEAREST, GL_LINEAR,
			GL_LINEAR_MIPMAP_LINEAR, GL_NEAREST_MIPMAP_NEAREST };
		char name[64];

		begin();
		make_framebuffer(GL_RGBA8, 1, i == 1 ? 4 : 0, GL_NONE);
		use_texture(i == 2 ? GL_RGBA32F : GL_RGBA8, filters[i]);
		if (i == 3)
			use_glsl("#version 130\nin vec2 uv;\n"
				 "uniform sampler2D t;\nvoid main() { "
				 "gl_FragColor = textureLod(t, uv, uv.y) + "
				 "texture(t, uv * uv, 0.5); }\n");
		snprintf(name, sizeof(name), "texture-%d", i);
		end(name);
	}

	begin();
	make_framebuffer(GL_RGBA8, 1, 0, GL_NONE);
	glEnable(GL_BLEND);
	glBlendFunc(GL_SRC1_COLOR, GL_ONE_MINUS_SRC1_COLOR);
	use_glsl("#version 130\n"
		 "#extension GL_ARB_explicit_attrib_location: require\n"
		 "layout(location = 0, index = 0) out vec4 a;\n"
		 "layout(location = 0, index = 1) out vec4 b;\n"
		 "void main() { a = gl_Color; b = gl_Color.wzyx; }\n");
	end("dual-source");

	begin();
	make_framebuffer(GL_RGBA8, 1, 0, GL_NONE);
	glEnable(GL_FRAGMENT_PROGRAM_ARB);
	const char *fp = "!!ARBfp1.0\nTEMP t;\nMUL t, fragment.color, "
		"program.env[0];\nKIL t;\nLRP result.color, t.x, t, "
		"fragment.position;\nEND\n";
	glProgramStringARB(GL_FRAGMENT_PROGRAM_ARB,
			   GL_PROGRAM_FORMAT_ASCII_ARB, strlen(fp), fp);
	glProgramEnvParameter4fARB(GL_FRAGMENT_PROGRAM_ARB, 0, .5, 1, .25, 1);
	end("arb-program");
	glDisable(GL_FRAGMENT_PROGRAM_ARB);
}

int
main(int argc, char **argv)
{
	mutate = argc > 1 && strcmp(argv[1], "mutate") == 0;
	make_context();
	printf("renderer %s\n", glGetString(GL_RENDERER));
	blending();
	tests();
	shaders();
	return 0;
}
