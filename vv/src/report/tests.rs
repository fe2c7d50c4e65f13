//! Behaviour of whole reports.

use super::*;
use std::collections::BTreeMap;
use std::error::Error as _;
use std::fs;

const SVG: &str = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"8\" height=\"4\">\
                   <path d=\"M0 0h8\" stroke=\"#0072B2\"/></svg>";

fn table() -> Table {
    Table {
        id: "norms".into(),
        caption: "Errors of the *density*".into(),
        columns: vec![
            Column::text("case"),
            Column::number("$L_1$", "kg/m³"),
            Column { align: Align::Center, ..Column::text("verdict") },
        ],
        rows: vec![
            vec![
                "Noh, `n = 200`".into(),
                Cell::number(0.044_812_3, 4),
                Cell::verdict(Status::Pass),
            ],
            vec!["a|b, \"c\"".into(), Cell::number(1.3e-15, 2).status(Status::Fail), "".into()],
        ],
    }
}

fn report() -> Report {
    let figure = Block::Figure { id: "noh".into(), caption: "Noh & exact".into() };
    let mut noh = Section::new("noh", "Noh", vec![Block::Table(table()), figure]);
    let equation =
        Block::Equation { tex: "p = (\\gamma - 1) \\rho e".into(), number: Some("1".into()) };
    let callout = Block::Callout { kind: Status::Warn, text: "Look at `x`.".into() };
    noh.subsections.push(Section::new("gas", "Gas", vec![equation, callout]));
    Report {
        title: "Verification <report>".into(),
        subtitle: "preset *default*".into(),
        summary: Summary {
            text: "Nearly all is well.".into(),
            counts: vec![(Status::Pass, 1), (Status::Fail, 1)],
        },
        sections: vec![
            noh,
            Section::new(
                "origin",
                "Provenance",
                vec![
                    Block::Definitions(vec![("seed".into(), "7".into())]),
                    Block::List(vec!["one".into(), "two".into()]),
                ],
            ),
        ],
    }
}

fn figures() -> BTreeMap<String, Drawing> {
    [("noh".to_owned(), SVG.into())].into()
}

#[test]
fn markdown_is_github_flavoured() {
    insta::assert_snapshot!(markdown(&report()), @r##"
    # Verification \<report\>

    preset *default*

    Nearly all is well.

    **1 pass, 1 fail**

    ## <a id="noh"></a>1 Noh

    <a id="tab-norms"></a>**Table 1** – Errors of the *density* ([CSV](tables/norms.csv))

    | case | $L_1$ / kg/m³ | verdict |
    | :-- | --: | :-: |
    | Noh, `n = 200` | 0.04481 | ✓ pass |
    | a\|b, "c" | 1.3×10⁻¹⁵ ✗ fail |  |

    <a id="fig-noh"></a>![Noh & exact](figures/noh.svg)

    **Figure 1** – Noh & exact

    ### <a id="gas"></a>1.1 Gas

    $$
    p = (\gamma - 1) \rho e \tag{1}
    $$

    > [!WARNING]
    > Look at `x`.

    ## <a id="origin"></a>2 Provenance

    - **seed**: 7

    - one
    - two
    "##);
}

/// The contents group neighbours under one heading and say how the required claims of a section stand.
#[test]
fn contents_have_groups_and_verdicts() {
    let plain = html(&report(), &figures(), Pictures::Beside).unwrap();
    assert!(!plain.contains("class=\"group\"") && !plain.contains("class=\"nav-note\""));
    let mut report = report();
    report.sections[0].tally = Some(Tally { held: 2, failed: 1, missing: 0 });
    report.sections.iter_mut().for_each(|section| section.group = "Line".into());
    report.sections.push(Section::new("rod", "Rod", Vec::new()).within("Space"));
    let page = html(&report, &figures(), Pictures::Beside).unwrap();
    let (contents, _) = page.split_once("</nav>").unwrap();
    let groups = |name: &str| contents.matches(&format!("<li class=\"group\">{name}</li>")).count();
    assert_eq!((groups("Line"), groups("Space")), (1, 1));
    assert_eq!(contents.matches("class=\"tally").count(), 1);
    assert!(contents.contains("class=\"tally fail\"") && contents.contains("2 of 3"));
    let status = |failed, missing| Tally { held: 1, failed, missing }.status();
    assert_eq!(
        [status(0, 0), status(0, 1), status(1, 1)],
        [Status::Pass, Status::Warn, Status::Fail]
    );
}

#[test]
fn numbers_of_few_decimals_show_no_more() {
    let text = |value| Cell::fixed(value, 2).text;
    assert_eq!(text(0.089_999_999_999_999_86), "0.09");
    assert_eq!(text(-0.02), "−0.02");
    assert_eq!(text(-1e-17), "0.00");
    assert_eq!(Cell::fixed(0.089_999_999_999_999_86, 2).value, Some(0.09));
}

#[test]
fn csv_keeps_whole_numbers_and_verdicts() {
    insta::assert_snapshot!(csv(&table()), @r#"
    case,L_1 (kg/m³),L_1 verdict,verdict
    "Noh, n = 200",0.0448123,,pass
    "a|b, ""c""",1.3e-15,fail,
    "#);
}

#[test]
fn page_is_self_contained_themed_and_escaped() {
    let page = html(&report(), &figures(), Pictures::Beside).unwrap();
    assert!(page.contains("<title>Verification &#60;report&#62;</title>"));
    assert!(page.contains("stroke=\"var(--fig-s1,#0072b2)\""));
    assert!(page.contains("<b>Figure 1</b> – Noh &amp; exact"));
    assert!(page.contains("<span class=\"no\">1.1</span> Gas</h3>"));
    assert!(page.contains("1.3×10⁻¹⁵<span class=\"word\"> fail</span>"));
    assert!(page.contains("<math") && page.contains("<span class=\"eqno\">(1)</span>"));
    // Its own script alone, which reads nothing.
    assert_eq!(page.matches("<script").count(), 1);
    for outside in ["<link", "@import", "src=", "fetch", "XMLHttpRequest", "import("] {
        assert!(!page.contains(outside), "{outside}");
    }
    assert_eq!(page, html(&report(), &figures(), Pictures::Beside).unwrap());
}

#[test]
fn contradictions_are_errors() {
    let with = |block: Block| Report {
        sections: vec![Section::new("a", "A", vec![block])],
        ..Report::default()
    };
    let none = BTreeMap::new();
    let missing = with(Block::Figure { id: "x".into(), caption: String::new() });
    assert!(matches!(html(&missing, &none, Pictures::Beside), Err(ReportError::MissingFigure(_))));
    let escaping = with(Block::Table(Table { id: "../x".into(), ..Table::default() }));
    assert!(matches!(html(&escaping, &none, Pictures::Beside), Err(ReportError::Id(_))));
    let ragged = with(Block::Table(Table { columns: vec![], ..table() }));
    assert!(matches!(html(&ragged, &none, Pictures::Beside), Err(ReportError::Ragged(_))));
    let mut twice = with(Block::Table(table()));
    twice.sections[0].blocks.push(Block::Table(table()));
    assert!(matches!(html(&twice, &none, Pictures::Beside), Err(ReportError::Duplicate(_))));
}

#[test]
fn a_new_report_replaces_the_old_and_nothing_else() {
    let folder = tempfile::tempdir().unwrap();
    let dir = folder.path().join("new/report");
    let mut more = figures();
    more.insert("old".into(), SVG.into());
    write(&report(), &more, &dir).unwrap();
    assert!(dir.join("figures/old.png").exists());
    fs::write(dir.join("figures/mine.svg"), "mine").unwrap();
    // A run that was killed left something behind.
    fs::create_dir_all(dir.join(".report-partial/figures")).unwrap();
    write(&report(), &figures(), &dir).unwrap();
    assert!(!dir.join("figures/old.svg").exists() && !dir.join("figures/old.png").exists());
    assert!(!dir.join(".report-partial").exists());
    for file in
        ["index.html", "report.md", "figures/noh.png", "figures/mine.svg", "tables/norms.csv"]
    {
        assert!(dir.join(file).exists(), "{file}");
    }
}

#[test]
fn pictures_are_in_the_page_and_beside_it() {
    let folder = tempfile::tempdir().unwrap();
    let mut shown = report();
    let picture = |id: &str| Block::Picture { id: id.into(), caption: "A \"rod\"".into() };
    shown.sections[1].blocks.push(picture("rod"));
    let mut drawings = figures();
    let (light, dark) = (b"\x89PNG, light".to_vec(), b"\x89PNG, dark".to_vec());
    let drawing = Drawing::Picture { light: light.clone(), dark: dark.clone() };
    drawings.insert("rod".into(), drawing);
    write(&shown, &drawings, folder.path()).unwrap();
    assert_eq!(fs::read(folder.path().join("figures/rod.png")).unwrap(), light);
    assert_eq!(fs::read(folder.path().join("figures/rod-dark.png")).unwrap(), dark);
    let page = fs::read_to_string(folder.path().join("index.html")).unwrap();
    assert!(page.contains("alt=\"A &quot;rod&quot;\""), "{page}");
    assert!(page.contains("srcset=\"figures/rod-dark.png\"") && !page.contains("data:"), "{page}");
    assert!(page.contains("<img loading=\"lazy\"") && page.contains("src=\"figures/rod.png\""));
    let whole = html(&shown, &drawings, Pictures::Within).unwrap();
    assert_eq!(whole.matches("data:image/png;base64,").count(), 2);
    assert!(!whole.contains("figures/"), "nothing beside it");
    assert!(page.contains("<b>Figure 2</b>"));
    assert!(markdown(&shown).contains("![A \"rod\"](figures/rod.png)\n\n**Figure 2** – A"));
    // One that is gone from the report goes from the folder.
    write(&report(), &figures(), folder.path()).unwrap();
    assert!(!folder.path().join("figures/rod-dark.png").exists());
    assert!(matches!(
        html(&shown, &figures(), Pictures::Beside),
        Err(ReportError::MissingFigure(_))
    ));
    shown.sections[0].blocks.push(picture("rod"));
    assert!(matches!(html(&shown, &drawings, Pictures::Beside), Err(ReportError::Duplicate(_))));
}

#[test]
fn refusals_name_path_and_cause() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("file");
    fs::write(&file, "").unwrap();
    for dir in [file.clone(), file.join("below")] {
        let error = write(&report(), &figures(), &dir).unwrap_err();
        assert!(matches!(&error, ReportError::Io { .. }) && error.source().is_some());
        assert!(error.to_string().contains(dir.to_str().unwrap()), "{error}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_read_only_file_system_refuses() {
    let error = write(&report(), &figures(), "/proc/whipple".as_ref()).unwrap_err();
    assert!(error.to_string().starts_with("cannot create the folder `/proc/whipple"), "{error}");
}

#[test]
fn something_in_the_way_leaves_no_index() {
    let folder = tempfile::tempdir().unwrap();
    let dir = folder.path();
    write(&report(), &figures(), dir).unwrap();
    fs::remove_file(dir.join("tables/norms.csv")).unwrap();
    fs::create_dir_all(dir.join("tables/norms.csv/full")).unwrap();
    let error = write(&report(), &figures(), dir).unwrap_err();
    assert!(error.to_string().contains("norms.csv"), "{error}");
    assert!(!dir.join("index.html").exists() && !dir.join(".report-partial").exists());
}

#[test]
fn a_folder_that_cannot_be_staged_keeps_the_old_report() {
    let folder = tempfile::tempdir().unwrap();
    write(&report(), &figures(), folder.path()).unwrap();
    let broken = [("noh".to_owned(), "no svg".into())].into();
    let error = write(&report(), &broken, folder.path()).unwrap_err();
    assert!(matches!(error, ReportError::Picture { .. }));
    assert!(folder.path().join("index.html").exists());
}
