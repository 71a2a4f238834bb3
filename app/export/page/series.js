// The series of numbers that the page carries: page_series.h of the program says how they are packed.

function bytesOf(base64) {
  const text = atob(base64), bytes = new Uint8Array(text.length);
  for (let k = 0; k < text.length; ++k) bytes[k] = text.charCodeAt(k);
  return bytes;
}

async function inflated(bytes) {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

// Reads series one after the other: each is rows x frames, the frames of a row side by side.
class SeriesReader {
  constructor(bytes, frames) {
    this.bytes = bytes;
    this.frames = frames;
    this.at = 0;
  }

  residual() {
    let value = 0, weight = 1, byte;
    do {
      byte = this.bytes[this.at++];
      value += (byte & 127) * weight;
      weight *= 128;
    } while (byte >= 128);
    return value % 2 === 0 ? value / 2 : -(value + 1) / 2;
  }

  // Rows of zeros at the end are not in the page: they are added up to a multiple of `width`, and `least` at least.
  next([rows, quantum], width, least = 0) {
    const all = Math.max(width * Math.ceil(rows / width), least), values = new Float32Array(all * this.frames);
    for (let row = 0; row < rows; ++row) {
      const differences = this.bytes[this.at++];
      let last = 0, before = 0;
      for (let k = 0; k < this.frames; ++k) {
        const residual = this.residual();
        const now = residual + (differences === 2 ? 2 * last - before : differences === 1 ? last : 0);
        values[row * this.frames + k] = quantum * now;
        before = last;
        last = now;
      }
    }
    return { rows: all, frames: this.frames, values };
  }
}

// The numbers of a series at a time counted in frames: between two frames in proportion, unless a new parametrisation
// begins with the second.
function numbersAt(series, time, breaks, out) {
  const frame = Math.min(Math.floor(time), series.frames - 1), next = Math.min(frame + 1, series.frames - 1);
  const share = breaks.includes(next) ? 0 : time - frame;
  if (!out || out.length !== series.rows) out = new Float64Array(series.rows);
  for (let row = 0, at = 0; row < series.rows; ++row, at += series.frames)
    out[row] = (1 - share) * series.values[at + frame] + share * series.values[at + next];
  return out;
}
