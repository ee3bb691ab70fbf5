//! Joints proposed for two placed parts, whose geometry is written here.
//!
//! Oracle: a plate of 100 x 60 x 10 mm with two holes of 8.02 mm, and a cover with two pins of 8 mm that stands on it. The parts are turned
//! in space, so no number of the study is one of the file.

use std::fmt::Write;

use sensitol_step::tables::{StudyTables, TableRequest, tables_of};

/// Entities of a file, numbered as they are added.
#[derive(Default)]
struct Lines {
    text: String,
    next: u64,
}

impl Lines {
    fn add(&mut self, entity: &str) -> u64 {
        self.next += 1;
        writeln!(self.text, "#{}={entity};", self.next).unwrap();
        self.next
    }

    fn point(&mut self, [x, y, z]: [f64; 3]) -> u64 {
        self.add(&format!("CARTESIAN_POINT('',({x:?},{y:?},{z:?}))"))
    }

    fn placement(&mut self, at: [f64; 3], [x, y, z]: [f64; 3], [u, v, w]: [f64; 3]) -> u64 {
        let at = self.point(at);
        let z = self.add(&format!("DIRECTION('',({x:?},{y:?},{z:?}))"));
        let x = self.add(&format!("DIRECTION('',({u:?},{v:?},{w:?}))"));
        self.add(&format!("AXIS2_PLACEMENT_3D('',#{at},#{z},#{x})"))
    }

    /// Face with straight edges.
    fn face(&mut self, surface: &str, same: bool, corners: &[[f64; 3]]) -> u64 {
        let surface = self.add(surface);
        let vertices: Vec<u64> = (corners.iter())
            .map(|&corner| {
                let point = self.point(corner);
                self.add(&format!("VERTEX_POINT('',#{point})"))
            })
            .collect();
        let mut edges = Vec::new();
        for (index, vertex) in vertices.iter().enumerate() {
            let next = vertices[(index + 1) % vertices.len()];
            let edge = self.add(&format!("EDGE_CURVE('',#{vertex},#{next},$,.T.)"));
            edges.push(format!("#{}", self.add(&format!("ORIENTED_EDGE('',*,*,#{edge},.T.)"))));
        }
        let edges = self.add(&format!("EDGE_LOOP('',({}))", edges.join(",")));
        let bound = self.add(&format!("FACE_OUTER_BOUND('',#{edges},.T.)"));
        self.add(&format!("ADVANCED_FACE('',(#{bound}),#{surface},.{}.)", if same { "T" } else { "F" }))
    }

    /// Horizontal rectangle that looks up or down.
    fn level(&mut self, height: f64, up: f64) -> u64 {
        let at = self.placement([0.0, 0.0, height], [0.0, 0.0, up], [1.0, 0.0, 0.0]);
        let corners = [[0.0, 0.0, height], [100.0, 0.0, height], [100.0, 60.0, height], [0.0, 60.0, height]];
        self.face(&format!("PLANE('',#{at})"), true, &corners)
    }

    /// Vertical cylinder: a pin, or a hole if `same` is false.
    fn cylinder(&mut self, x: f64, [low, high]: [f64; 2], radius: f64, same: bool) -> u64 {
        let at = self.placement([x, 30.0, low], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]);
        let corners = [low, high].map(|z| [x + radius, 30.0, z]);
        self.face(&format!("CYLINDRICAL_SURFACE('',#{at},{radius:?})"), same, &corners)
    }

    /// Part with a solid of some faces. Returns definition, representation and origin.
    fn part(&mut self, name: &str, faces: &[u64], context: u64) -> [u64; 3] {
        let faces = faces.iter().map(|face| format!("#{face}")).collect::<Vec<_>>().join(",");
        let shell = self.add(&format!("CLOSED_SHELL('',({faces}))"));
        let solid = self.add(&format!("MANIFOLD_SOLID_BREP('',#{shell})"));
        let origin = self.placement([0.0; 3], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]);
        let shape = self.add(&format!("ADVANCED_BREP_SHAPE_REPRESENTATION('',(#{solid},#{origin}),#{context})"));
        let product = self.add(&format!("PRODUCT('{name}','{name}','',())"));
        let formation = self.add(&format!("PRODUCT_DEFINITION_FORMATION('','',#{product})"));
        let definition = self.add(&format!("PRODUCT_DEFINITION('','',#{formation},$)"));
        let of = self.add(&format!("PRODUCT_DEFINITION_SHAPE('','',#{definition})"));
        self.add(&format!("SHAPE_DEFINITION_REPRESENTATION(#{of},#{shape})"));
        [definition, shape, origin]
    }
}

/// File of the assembly. `reversed` states the transformations from the assembly to the part, as some writers do.
fn assembly(reversed: bool) -> String {
    let mut lines = Lines::default();
    let length = lines.add("(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.))");
    let context = lines.add(&format!(
        "(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNIT_ASSIGNED_CONTEXT((#{length}))REPRESENTATION_CONTEXT('',''))"
    ));
    let plate = [
        lines.level(10.0, 1.0),
        lines.level(0.0, -1.0),
        lines.cylinder(20.0, [0.0, 10.0], 4.01, false),
        lines.cylinder(80.0, [0.0, 10.0], 4.01, false),
    ];
    let cover = [
        lines.level(0.0, -1.0),
        lines.cylinder(20.0, [-8.0, 0.0], 4.0, true),
        lines.cylinder(80.0, [-8.0, 0.0], 4.0, true),
    ];
    let parts = [lines.part("Plate", &plate, context), lines.part("Cover", &cover, context)];
    let whole = lines.part("Assembly", &[], context);
    // Both parts are turned by 120 degrees about (1, 1, 1): z becomes x, x becomes y. The cover is 10 mm above the plate.
    let (z, x) = ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0]);
    for ([definition, shape, origin], at) in parts.into_iter().zip([[5.0, 6.0, 7.0], [15.0, 6.0, 7.0]]) {
        let place = lines.placement(at, z, x);
        let use_of = lines.add(&format!("NEXT_ASSEMBLY_USAGE_OCCURRENCE('1','','',#{},#{definition},$)", whole[0]));
        let of = lines.add(&format!("PRODUCT_DEFINITION_SHAPE('','',#{use_of})"));
        let ([from, to], [first, last]) = match reversed {
            false => ([shape, whole[1]], [origin, place]),
            true => ([whole[1], shape], [place, origin]),
        };
        let moved = lines.add(&format!("ITEM_DEFINED_TRANSFORMATION('','',#{first},#{last})"));
        let relation = lines.add(&format!("(REPRESENTATION_RELATIONSHIP('','',#{from},#{to})REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION(#{moved})SHAPE_REPRESENTATION_RELATIONSHIP())"));
        lines.add(&format!("CONTEXT_DEPENDENT_SHAPE_REPRESENTATION(#{relation},#{of})"));
    }
    format!("ISO-10303-21;\nHEADER;\nENDSEC;\nDATA;\n{}ENDSEC;\nEND-ISO-10303-21;\n", lines.text)
}

fn tables(text: &str) -> StudyTables {
    tables_of(text.as_bytes(), &TableRequest { joints: true, ..TableRequest::default() }).unwrap()
}

#[test]
fn faces_and_pins_that_coincide_are_joints() {
    let found = tables(&assembly(false));
    assert_eq!(found.part_names, ["plate", "cover"]);
    // The face takes three motions, the first pin two of the others, and one turn is left for the second pin: it needs a slot.
    assert_eq!(
        found.joints,
        [
            "# plate and cover:",
            "# joint_1 = { on = \"plate.face_1\", against = \"cover.face_1\", takes = 3 }",
            "# joint_2 = { hole = \"plate.hole_1\", pin = \"cover.pin_1\", takes = 2 }",
            "# joint_3 = { hole = \"plate.hole_2\", pin = \"cover.pin_2\" }  # one motion is left: a slot",
        ]
    );
    // 120 degrees about (1, 1, 1) as a rotation vector: 120/sqrt(3) in each coordinate.
    let turned = "turned = [69.282032303, 69.282032303, 69.282032303]";
    let expected = format!(
        "\n[parts.plate]\nat = [5, 6, 7]\n{turned}\nface_1 = {{ plane = [50, 30, 10], normal = \"z\", size = [100, 60] }}\n\
         hole_1 = {{ axis = [20, 30, 5], along = \"z\", diameter = 8.02, length = 10 }}\nhole_2 = {{ axis = [80, 30, 5], along = \"z\", diameter = 8.02, length = 10 }}\n\
         \n[parts.cover]\nat = [15, 6, 7]\n{turned}\nface_1 = {{ plane = [50, 30, 0], normal = \"-z\", size = [100, 60] }}\n\
         pin_1  = {{ axis = [20, 30, -4], along = \"z\", diameter = 8, length = 8 }}\npin_2  = {{ axis = [80, 30, -4], along = \"z\", diameter = 8, length = 8 }}\n"
    );
    assert_eq!(found.parts, expected);
}

#[test]
fn reversed_transformations_place_parts_alike() {
    assert_eq!(tables(&assembly(true)), tables(&assembly(false)));
}

#[test]
fn parts_apart_have_no_joint() {
    let apart = assembly(false).replace("(15.0,6.0,7.0)", "(15.1,6.0,7.0)");
    let found = tables(&apart);
    // The pins still are in their holes, and the first one takes all that a pin can.
    assert!(found.joints.iter().all(|line| !line.contains("against")), "{:?}", found.joints);
    assert!(found.joints[1].contains("takes = 4"), "{:?}", found.joints);
    let far = assembly(false).replace("(15.0,6.0,7.0)", "(15.0,6.0,300.0)");
    let error = tables_of(far.as_bytes(), &TableRequest { joints: true, ..TableRequest::default() }).unwrap_err();
    assert_eq!(error.to_string(), "no semantic tolerances, and no faces of two placed parts that coincide");
}
