/* Counts what holds, and tells what does not; the last line is `N passed, N failed`. */
const MOST = 400; /* characters of a value that are shown */

export class Tally {
  passed = 0;
  failed = 0;

  is(what, holds) {
    if (holds) {
      this.passed++;
    } else {
      this.failed++;
      console.log(`FAILED: ${what}`);
    }
    return Boolean(holds);
  }

  equal(what, found, expected) {
    const holds = this.is(what, found === expected);
    if (!holds)
      console.log(`  found    ${String(found).slice(0, MOST)}\n  expected ${String(expected).slice(0, MOST)}`);
    return holds;
  }

  end() {
    console.log(`${this.passed} passed, ${this.failed} failed`);
    process.exitCode = this.failed > 0 || this.passed === 0 ? 1 : 0;
  }
}
