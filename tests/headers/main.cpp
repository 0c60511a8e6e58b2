// SPDX-License-Identifier: BSD-3-Clause
// Each public header by itself: the sources beside this one, one for each, call what theirs
// declares. That they compile and link is the test.
int main() { return 0; }
