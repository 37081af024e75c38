// The list of scenes: states worth a look to begin with, then the scenes that the program comes with, a line each.

/** Where the page begins (the first one), and its neighbors. */
export const beginnings = [
  {label: 'A crowd of fibers that may not cross', scene: 'dense', settings: [['fibers.0.count', '80']],
   about: 'Eighty stiff fibers in a box as long as they are. They bounce off each other and never pass through. One is marked: its trace grows.'},
  {label: 'The same crowd by the paper’s rule', scene: 'dense', settings: [['fibers.0.count', '80'], ['crossing.rule', 'sequential']],
   about: 'One vertex moves at a time, and a move that would cross a bond is rejected. Look at the energy: this rule heats.'},
  {label: 'The same crowd as ghosts', scene: 'dense', settings: [['fibers.0.count', '80'], ['crossing.forbidden', 'false']],
   about: 'Fibers pass through each other. No contacts, and the marked fiber finds no tube.'},
];

const lines = {
  'bead-fibers': ['a bead pulled through a network', 'A bead is pulled through a network of thick fibers. It pushes them aside; behind it they close.'],
  'bead-slit': ['a bead between walls', 'A bead swims in the flow between two walls, nearer to one of them.'],
  bead: ['a bead in a trap that swings', 'A trap swings, and the bead follows, late by the friction of the solvent.'],
  chains: ['flexible chains', 'Ten flexible chains in much solvent, the paper’s dilute solution. Each coils and uncoils.'],
  couette: ['Couette flow', 'Two walls slide past each other. The solvent between them is sheared: a line, with a little slip at the walls.'],
  dense: ['a dense crowd', 'Four hundred fibers, a mesh of one cell. Here a tube shows: d² of the middle of a fiber levels off.'],
  'dense-crossable': ['the dense crowd as ghosts', 'The same crowd, and fibers pass through each other: no tube, d² goes on growing.'],
  dumbbells: ['dumbbells in shear', 'Each solvent particle has a partner on a spring. The flow stretches and tilts the springs.'],
  'dumbbells-walls': ['dumbbells between walls', 'The fluid of dumbbells between walls that slide past each other.'],
  'fibers-couette': ['fibers between walls', 'Fibers between walls that slide past each other. They bounce off the walls.'],
  'fibers-shear': ['fibers in shear', 'The images above and below slide past the box, and fibers turn into the flow.'],
  kolmogorov: ['a flow like a sine', 'A force that is a sine of y drives a flow that is one. Its height measures the viscosity.'],
  plane: ['a plane', 'Two dimensions: a fluid in a plane, and chains that may pass through each other, since nothing can pass over.'],
  poiseuille: ['Poiseuille flow', 'A force along two walls at rest drives a flow like a parabola.'],
  rings: ['linked rings', 'Two rings are linked and two are not. That stays so for ever; set crossing to “free” and it does not.'],
  semidilute: ['the paper’s suspension', 'The paper’s own: 100 fibers of 64 vertices and 163,840 solvent particles. It is large, so it is slow here.'],
  shear: ['a sheared box', 'The solvent alone, sheared by images that slide: a linear profile without walls.'],
  solvent: ['the solvent alone', 'Nothing but solvent, 163,840 particles: temperature 1, energy and momentum kept.'],
  thick: ['thick fibers', 'Tubes that exclude each other, of three kinds: stiff ones, thin ones and rings.'],
};

/** The words of a shipped scene: [short, sentence]; of one that this list has not, what its file says. */
export const words_of_scene = scene => lines[scene.name] ?? ['', scene.about];
