/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

/**
 * \file scenes.c
 * Three scenes that know nothing of the k-buffer, whose instructions
 * ../stock-instructions counts on stock and on patched Mesa.
 *
 * usage: scenes SCENE FRAMES [PLANTED]
 *
 * Draws two frames first, which compile all shaders and fill all caches.  Then
 * the process forks: the child draws FRAMES more and prints a checksum of the
 * last one's pixels; the parent waits for it and ends, too.  So one run counts
 * both, the whole process and, by the difference, what the frames alone cost.
 * (This wants a driver without threads, LP_NUM_THREADS=0.)
 *
 * PLANTED is a number of instructions to spend in vain at each draw: the
 * comparison has to see that.
 */

#include "context.h"
#include <math.h>
#include <stdint.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#define SIZE 96
#define WARM_UP 2

static GLuint
make_framebuffer(int attachments, int samples)
{
	GLenum buffers[8];
	GLuint fbo, rb;

	glGenFramebuffers(1, &fbo);
	glBindFramebuffer(GL_FRAMEBUFFER, fbo);
	for (int i = 0; i <= attachments; i++) {
		const GLenum depth = GL_DEPTH_STENCIL_ATTACHMENT;

		buffers[i % 8] = GL_COLOR_ATTACHMENT0 + i;
		glGenRenderbuffers(1, &rb);
		glBindRenderbuffer(GL_RENDERBUFFER, rb);
		glRenderbufferStorageMultisample(
			GL_RENDERBUFFER, samples, i < attachments ? GL_RGBA8 :
			GL_DEPTH24_STENCIL8, SIZE, SIZE);
		glFramebufferRenderbuffer(GL_FRAMEBUFFER, i < attachments ?
					  buffers[i] : depth, GL_RENDERBUFFER,
					  rb);
	}
	glDrawBuffers(attachments, buffers);
	if (glCheckFramebufferStatus(GL_FRAMEBUFFER) !=
	    GL_FRAMEBUFFER_COMPLETE)
		die("incomplete framebuffer");
	glViewport(0, 0, SIZE, SIZE);
	return fbo;
}

static GLuint
make_texture(void)
{
	uint8_t texels[32 * 32 * 4];
	GLuint tex;

	for (int i = 0; i < 32 * 32 * 4; i++)
		texels[i] = i * 37 + i / 128 * 11;
	glGenTextures(1, &tex);
	glBindTexture(GL_TEXTURE_2D, tex);
	glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, 32, 32, 0, GL_RGBA,
		     GL_UNSIGNED_BYTE, texels);
	glGenerateMipmap(GL_TEXTURE_2D);
	glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER,
			GL_LINEAR_MIPMAP_LINEAR);
	return tex;
}

/** A wavy sheet of N by N squares: position, normal, texture coordinates. */
#define N 24

static void
make_sheet(void)
{
	static float vertices[(N + 1) * (N + 1)][8];
	static GLushort indices[N * N][6];
	GLuint buffers[2];

	for (int i = 0; i < (N + 1) * (N + 1); i++) {
		const float x = i % (N + 1) * 2.0f / N - 1;
		const float y = i / (N + 1) * 2.0f / N - 1;
		const float v[] = { x, y, .4f * sinf(5 * x) * cosf(4 * y),
				    -2 * cosf(5 * x), 0, 1, 3 * x, 3 * y };

		memcpy(vertices[i], v, sizeof(v));
	}
	for (int i = 0; i < N * N; i++) {
		const GLushort a = i / N * (N + 1) + i % N, b = a + N + 1;
		const GLushort square[] = { a, a + 1, b, b, a + 1, b + 1 };

		memcpy(indices[i], square, sizeof(square));
	}
	glGenBuffers(2, buffers);
	glBindBuffer(GL_ARRAY_BUFFER, buffers[0]);
	glBufferData(GL_ARRAY_BUFFER, sizeof(vertices), vertices,
		     GL_STATIC_DRAW);
	glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers[1]);
	glBufferData(GL_ELEMENT_ARRAY_BUFFER, sizeof(indices), indices,
		     GL_STATIC_DRAW);
	glInterleavedArrays(GL_T2F_N3F_V3F, 0, NULL);
	glVertexPointer(3, GL_FLOAT, 32, (void *)0);
	glNormalPointer(GL_FLOAT, 32, (void *)12);
	glTexCoordPointer(2, GL_FLOAT, 32, (void *)24);
}

/** Called before each draw: where it shall be, and what is planted. */
static int planted;

static void
turn(int frame, int object)
{
	for (volatile int i = 0; i < planted / 4; i++)
		;
	glLoadIdentity();
	glRotatef(7 * frame + 50 * object, 1, 2, .5f);
	glScalef(.8f, .8f, .8f);
}

/** An opaque, textured, lit mesh, with a depth buffer. */
static void
init_mesh(void)
{
	make_framebuffer(1, 0);
	make_texture();
	make_sheet();
}

static void
draw_mesh(int frame)
{
	glPushAttrib(GL_ENABLE_BIT | GL_DEPTH_BUFFER_BIT);
	glEnable(GL_DEPTH_TEST);
	glEnable(GL_TEXTURE_2D);
	glEnable(GL_LIGHTING);
	glEnable(GL_LIGHT0);
	for (int object = 0; object < 4; object++) {
		glDepthFunc(object % 2 ? GL_LEQUAL : GL_LESS);
		turn(frame, object);
		glDrawElements(GL_TRIANGLES, 6 * N * N, GL_UNSIGNED_SHORT,
			       NULL);
	}
	glPopAttrib();
}

/** Blending into three targets with four samples, resolved each frame. */
static GLuint blended, resolved;

static void
init_blend(void)
{
	static const char *sources[] = {
		"#version 130\nout vec2 uv;\nvoid main() { gl_Position = "
		"ftransform(); uv = gl_MultiTexCoord0.xy; }\n",
		"#version 130\nin vec2 uv;\nuniform sampler2D t;\n"
		"void main() { vec4 c = texture(t, uv); if (c.x > 0.9) "
		"discard; gl_FragData[0] = c; gl_FragData[1] = c.yzxw; "
		"gl_FragData[2] = vec4(gl_FragCoord.z); }\n"
	};
	GLuint program = glCreateProgram(), shader;

	for (int i = 0; i < 2; i++) {
		shader = glCreateShader(i ? GL_FRAGMENT_SHADER :
					GL_VERTEX_SHADER);
		glShaderSource(shader, 1, &sources[i], NULL);
		glCompileShader(shader);
		glAttachShader(program, shader);
	}
	glLinkProgram(program);
	glUseProgram(program);
	resolved = make_framebuffer(1, 0);
	blended = make_framebuffer(3, 4);
	make_texture();
	make_sheet();
}

static void
draw_blend(int frame)
{
	glBindFramebuffer(GL_FRAMEBUFFER, blended);
	glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
	glEnable(GL_BLEND);
	glBlendFunci(0, GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
	glBlendFunci(1, GL_ONE, GL_ONE);
	glBlendFunci(2, GL_DST_COLOR, GL_ZERO);
	for (int object = 0; object < 2; object++) {
		turn(frame, object);
		glColorMaski(1, 1, object, 1, 1);
		glDrawElements(GL_TRIANGLES, 6 * N * N, GL_UNSIGNED_SHORT,
			       NULL);
	}
	glBindFramebuffer(GL_DRAW_FRAMEBUFFER, resolved);
	glBlitFramebuffer(0, 0, SIZE, SIZE, 0, 0, SIZE, SIZE,
			  GL_COLOR_BUFFER_BIT, GL_NEAREST);
	glBindFramebuffer(GL_FRAMEBUFFER, resolved);
}

/**
 * Display lists, drawn by turns by an ARB fragment program and by the fixed
 * functions, with alpha test, stencil, fog and logic op.
 */
static GLuint list;

static void
init_lists(void)
{
	static const char fp[] = "!!ARBfp1.0\nTEMP t;\n"
		"TEX t, fragment.texcoord[0], texture[0], 2D;\n"
		"MUL t, t, fragment.color;\nMAD t.x, t.y, "
		"program.local[0].x, t.x;\nKIL t.x;\n"
		"MOV result.color, t;\nEND\n";

	make_framebuffer(1, 0);
	make_texture();
	glProgramStringARB(GL_FRAGMENT_PROGRAM_ARB,
			   GL_PROGRAM_FORMAT_ASCII_ARB, strlen(fp), fp);
	list = glGenLists(1);
	glNewList(list, GL_COMPILE);
	for (int strip = 0; strip < 6; strip++) {
		glBegin(GL_TRIANGLE_STRIP);
		for (int i = 0; i < 20; i++) {
			const float x = i * .1f - 1, y = strip * .3f - 1;

			glColor4f(i % 3 * .5f, strip * .2f, .5f, i * .05f);
			glTexCoord2f(i * .2f, strip);
			glVertex3f(x, y + (i % 2) * .4f, x * y);
		}
		glEnd();
	}
	glEndList();
}

static void
draw_lists(int frame)
{
	for (int object = 0; object < 8; object++) {
		glPushAttrib(GL_ALL_ATTRIB_BITS);
		turn(frame, object);
		glEnable(GL_DEPTH_TEST);
		if (object % 2) {
			glEnable(GL_FRAGMENT_PROGRAM_ARB);
			glProgramLocalParameter4fARB(GL_FRAGMENT_PROGRAM_ARB,
						     0, object, 0, 0, 0);
		} else {
			glEnable(GL_TEXTURE_2D);
			glEnable(GL_FOG);
			glEnable(GL_ALPHA_TEST);
			glAlphaFunc(GL_GREATER, .25f);
		}
		if (object >= 4) {
			glEnable(GL_STENCIL_TEST);
			glStencilFunc(GL_GEQUAL, object, 255);
			glStencilOp(GL_KEEP, GL_INCR, GL_REPLACE);
		}
		if (object == 2) {
			glEnable(GL_COLOR_LOGIC_OP);
			glLogicOp(GL_XOR);
		}
		glCallList(list);
		glPopAttrib();
	}
}

static const struct {
	const char *name;
	void (*init)(void);
	void (*draw)(int frame);
} scenes[] = {
	{ "mesh", init_mesh, draw_mesh },
	{ "blend", init_blend, draw_blend },
	{ "lists", init_lists, draw_lists },
};

static uint8_t pixels[SIZE * SIZE * 4];

static void
draw_frames(unsigned scene, int first, int end)
{
	for (int frame = first; frame < end; frame++) {
		glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT |
			GL_STENCIL_BUFFER_BIT);
		scenes[scene].draw(frame);
		glReadPixels(0, 0, SIZE, SIZE, GL_RGBA, GL_UNSIGNED_BYTE,
			     pixels);
	}
}

int
main(int argc, char **argv)
{
	const int frames = argc >= 3 ? atoi(argv[2]) : 0;
	uint64_t hash = 0xcbf29ce484222325;
	unsigned s = 0;
	int status;

	while (argc >= 3 && s < 3 && strcmp(argv[1], scenes[s].name))
		s++;
	if (frames < 1 || s == 3)
		die("usage: scenes SCENE FRAMES [PLANTED]");
	planted = argc > 3 ? atoi(argv[3]) : 0;
	make_context();
	printf("renderer %s\n", glGetString(GL_RENDERER));
	fflush(stdout);
	scenes[s].init();
	glClearColor(.1f, .2f, .3f, .4f);
	draw_frames(s, 0, WARM_UP);

	/* The checksum is in both, lest the difference has it. */
	if (fork() == 0)
		draw_frames(s, WARM_UP, WARM_UP + frames);
	else if (wait(&status) == -1 || status)
		die("the frames failed");
	for (size_t i = 0; i < sizeof(pixels); i++)
		hash = (hash ^ pixels[i]) * 0x100000001b3;
	if (glGetError() != GL_NO_ERROR)
		die("an error of the GL");
	printf("pixels %016llx\n", (unsigned long long)hash);
	return 0;
}
