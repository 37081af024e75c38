// A step taken apart by hand. begin(panel, page) fills the panel; as long as it is null the page has no such tab.
export const begin = null;
