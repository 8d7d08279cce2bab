/* SPDX-License-Identifier: Apache-2.0
 * In place of libjbig.so.0, which libtiff names: it is under the GPL, which the tarball would be then. These are the
 * functions that libtiff calls; each of them fails, and a TIFF file with JBIG compression is refused with a sentence.
 * JBIG is for black-and-white pages. */
void jbg_dec_init(void *state) { (void)state; }
int jbg_dec_in(void *state, unsigned char *data, unsigned long size, unsigned long *read) {
  (void)state, (void)data, (void)size, (void)read;
  return 0x70; /* as JBG_EIMPL: not implemented */
}
unsigned char *jbg_dec_getimage(const void *state, int plane) { return (void)state, (void)plane, (unsigned char *)0; }
long jbg_dec_getsize(const void *state) { return (void)state, 0; }
void jbg_dec_free(void *state) { (void)state; }
void jbg_enc_init(void *state, unsigned long width, unsigned long height, int planes, unsigned char **image,
                  void (*out)(unsigned char *, unsigned long, void *), void *file) {
  (void)state, (void)width, (void)height, (void)planes, (void)image, (void)out, (void)file;
}
void jbg_enc_out(void *state) { (void)state; }
void jbg_enc_free(void *state) { (void)state; }
int jbg_newlen(unsigned char *data, unsigned long size) { return (void)data, (void)size, 0x70; }
const char *jbg_strerror(int error) { return (void)error, "JBIG compression is not part of this build"; }
